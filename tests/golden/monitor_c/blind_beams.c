/* action stop; input v = topic /scan input w = topic /scan no_return 0 entity e { r: v.blind(0 deg, 30 deg) > 20 % or v.blind_gap(0 deg, 30 deg) > 5 deg or w.nearest(0 deg, 30 deg) < 1; } if e.r then { stop; }; */

… 4 lines of scan_texts.py: static double blind(
  /* 25 lines of scan */
}

… 9 lines of scan_texts.py: static double blind_gap(
  /*@ loop invariant 0 <= i <= count;
      loop invariant 0 <= beams <= i;
      loop invariant 0 < beams ==> has_beam(i, angle_min, angle_increment, start, end);
      loop invariant 0 <= widest <= i;
      loop invariant 0 < widest ==> has_blind(ranges, i, angle_min, angle_increment, range_min,
        range_max, start, end, zero_is_free);
      loop invariant has_blind(ranges, i, angle_min, angle_increment, range_min, range_max, start,
        end, zero_is_free) ==> 0 < widest;
      loop invariant run <= widest && head <= widest;
      loop assigns i, beams, head, run, widest;
      loop variant count - i; */
… 16 lines of scan_texts.py: for (size_t i = 0U; i < count; ++i) {
static bool observe_scan(
  small_monitor *m, const float *ranges, size_t ranges_count, double angle_min,
  double angle_increment, double range_min, double range_max)
{
  /* 8 lines of scan */
    m->v_blind = blind(
      ranges, ranges_count, angle_min, angle_increment, range_min, range_max, 0.0,
  /* 2 lines of scan */
    m->v_blind_gap = blind_gap(
      ranges, ranges_count, angle_min, angle_increment, range_min, range_max, 0.0,
      0.5235987755982989, false);
    news = store_truth(&m->v_blind_gap_known, is_number(m->v_blind_gap), news);
    news = store_truth(&m->v_blind_above_0_2, m->v_blind > 0.2, news);
    news = store_truth(
      &m->v_blind_gap_above_0_0872665,
      m->v_blind_gap > 0.08726646259971647,
      news);
  /* 3 lines of scan */
  if ((ranges_count <= SMALL_MOST_ELEMENTS) &&
    is_number(angle_min) &&
    is_number(angle_increment) &&
    is_number(range_min) &&
    is_number(range_max) &&
    scan_usable(ranges, ranges_count, range_min, range_max, true))
  {
    m->w_nearest = nearest(
      ranges, ranges_count, angle_min, angle_increment, range_min, range_max, 0.0,
      0.5235987755982989, true);
    news = store_truth(&m->w_nearest_known, is_number(m->w_nearest), news);
    m->w_blind = blind(
      ranges, ranges_count, angle_min, angle_increment, range_min, range_max, 0.0,
      0.5235987755982989, true);
    news = store_truth(&m->w_blind_known, is_number(m->w_blind), news);
    news = store_truth(&m->w_nearest_below_1, m->w_nearest < 1.0, news);
  } else {
    news = forget_w(m) || news;
  }
  return news;
}
