/* action stop; input v = topic /joints entity e { r: any(v.effort > 30 and not v.velocity > 1) or count(v.position in [0, 1)) > 2; } if e.r then { stop; }; */

/* How many entries satisfy: v.effort > 30 and not v.velocity > 1 */
static size_t matches_1(
  const double *v_effort, size_t v_effort_count, const double *v_velocity, size_t v_velocity_count)
{
  size_t found = 0U;
  size_t count = v_effort_count;
  if (v_velocity_count != count) {
    count = 0U;
  }
  /*@ loop invariant 0 <= i <= count;
      loop invariant found <= i;
      loop invariant 0 < found ==> (\exists integer k; 0 <= k < i && \gt_double(v_effort[k],
        (double)30.0) && !(\gt_double(v_velocity[k], (double)1.0)));
      loop invariant (\exists integer k; 0 <= k < i && \gt_double(v_effort[k], (double)30.0) &&
        !(\gt_double(v_velocity[k], (double)1.0))) ==> 0 < found;
      loop assigns i, found;
      loop variant count - i; */
  for (size_t i = 0U; i < count; ++i) {
    if ((v_effort[i] > 30.0) && (!(v_velocity[i] > 1.0))) {
      ++found;
    }
  }
  return found;
}

/* How many entries satisfy: v.position in [0, 1) */
static size_t matches_2(const double *v_position, size_t count)
{
  size_t found = 0U;
  /*@ loop invariant 0 <= i <= count;
      loop invariant found <= i;
      loop invariant 0 < found ==> (\exists integer k; 0 <= k < i && \ge_double(v_position[k],
        (double)0.0) && \lt_double(v_position[k], (double)1.0));
      loop invariant (\exists integer k; 0 <= k < i && \ge_double(v_position[k], (double)0.0) &&
        \lt_double(v_position[k], (double)1.0)) ==> 0 < found;
      loop assigns i, found;
      loop variant count - i; */
  for (size_t i = 0U; i < count; ++i) {
    if ((v_position[i] >= 0.0) && (v_position[i] < 1.0)) {
      ++found;
    }
  }
  return found;
}

static bool observe_v(
  small_monitor *m, const double *effort, size_t effort_count, const double *velocity,
  size_t velocity_count, const double *position, size_t position_count)
{
  bool news = false;
  if ((effort_count <= SMALL_MOST_ELEMENTS) &&
    are_numbers_float64(effort, effort_count) &&
    (velocity_count <= SMALL_MOST_ELEMENTS) &&
    are_numbers_float64(velocity, velocity_count) &&
    (position_count <= SMALL_MOST_ELEMENTS) &&
    are_numbers_float64(position, position_count))
  {
    news = store_integer(
      &m->v_matches,
      (int64_t)matches_1(effort, effort_count, velocity, velocity_count),
      news);
    news = store_truth(
      &m->v_matches_known,
      ((effort_count > 0U) && (effort_count == velocity_count)),
      news);
    news = store_integer(&m->v_matches_2, (int64_t)matches_2(position, position_count), news);
    news = store_truth(&m->v_matches_2_known, (position_count > 0U), news);
  /* 4 lines of vector */
}
