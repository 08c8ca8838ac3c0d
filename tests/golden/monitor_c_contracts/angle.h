/* action stop; input q = topic /imu.orientation entity e { r: q.roll() > 10 deg; } if e.r then { stop; }; */

/*@ predicate judged_e_r(small_monitor *m) =
      (m->e_r == SMALL_TRUE <==> (m->q_roll_known != 0 && (m->q_roll_above_0_174533 != 0))) &&
      (m->e_r == SMALL_FALSE <==> (m->q_roll_known != 0 && !(m->q_roll_above_0_174533 != 0))); */

/*@ assigns \nothing;
    check ensures formula_of_roll(\result, ux, uy, uz, uw);
    admit ensures is_roll(\result, ux, uy, uz, uw); */
static double roll(double ux, double uy, double uz, double uw);

/* Processes a message of /imu that arrives now. */
… 14 lines as in smallest.h: /*@ requires \valid(m);
    ensures (!\is_NaN(orientation_x) && !\is_NaN(orientation_y) && !\is_NaN(orientation_z) &&
      !\is_NaN(orientation_w)) ==> ((m->q_roll_known != 0 <==> !\is_NaN(m->q_roll)) && (\exists
      double length_1; is_length_of(length_1, orientation_x, orientation_y, orientation_z,
      orientation_w) && is_roll(m->q_roll, \div_double(orientation_x, length_1),
      \div_double(orientation_y, length_1), \div_double(orientation_z, length_1),
      \div_double(orientation_w, length_1))));
    ensures !(!\is_NaN(orientation_x) && !\is_NaN(orientation_y) && !\is_NaN(orientation_z) &&
      !\is_NaN(orientation_w)) ==> (m->q_roll_known == 0); */
static void take_q(
  small_monitor *m, double orientation_x, double orientation_y, double orientation_z,
  double orientation_w);
