/* action stop; input s = topic /name.data entity e { r: s = "auto"; } if e.r then { stop; }; */

/*@ predicate judged_e_r(small_monitor *m) =
      (m->e_r == SMALL_TRUE <==> (m->s_known != 0 && (m->s == 1))) &&
      (m->e_r == SMALL_FALSE <==> (m->s_known != 0 && !(m->s == 1))); */

/* Processes a message of /name that arrives now. */
/*@ requires \valid(m);
    requires sane(m);
    requires \valid_read(data + (0 .. data_length - 1));
    requires \separated(m, data + (0 .. data_length - 1));
… 12 lines as in smallest.h: assigns *m, emitted;
    ensures (m->s_known == 1); */
static void take_s(small_monitor *m, const char *data, size_t data_length);
