/* action stop; action horn; input v = topic /odom.twist.twist.linear.x entity e { r: v > 1; s: v > 2; } if e.r then { stop; if e.s then { horn; }; }; */

/*@ logic integer emitted_by_event(integer events, void *owner, integer now, integer
  was_behaviour_1_condition, integer behaviour_1_condition, integer was_behaviour_2_condition,
  integer behaviour_2_condition) =
      emitted_by_behave_behaviour_1(events, owner, now, was_behaviour_1_condition,
        behaviour_1_condition, was_behaviour_2_condition, behaviour_2_condition); */

/*@ predicate acted(small_monitor *m) =
      acted_behave_behaviour_1(m) &&
      acted_behave_behaviour_2(m); */
