/* input v = topic /odom.twist.twist.linear.x entity e { r: v > 1; s: v > 2; } action stop; action beep(times, text, loud, pitch, slow); behaviour near: if e.r then { stop; if e.s then { beep(-3, "a", true, 0.5, false); }; stop; }; */

typedef enum
{
  SMALL_TRUTH,
  SMALL_INTEGER,
  SMALL_NUMBER,
  SMALL_TEXT
} small_type;

… 3 lines of monitor.h.j2: /* An argument of an action: the member that its type names. */
  small_type type;
… 4 lines of monitor.h.j2: bool truth;
} small_argument;

  /* 5 lines of smallest */
  const small_argument *arguments;
  uint32_t count;
} small_site;

static const small_argument arguments_2[5] = {
  {SMALL_INTEGER, false, -INT64_C(3), 0.0, NULL},
  {SMALL_TEXT, false, 0, 0.0, "a"},
  {SMALL_TRUTH, true, 0, 0.0, NULL},
  {SMALL_NUMBER, false, 0, 0.5, NULL},
  {SMALL_TRUTH, false, 0, 0.0, NULL}
};

const small_site small_sites[SMALL_SITE_COUNT] = {
  {SMALL_ACTION_STOP, SMALL_BEHAVIOUR_NEAR, 2U, NULL, 0U},
  {SMALL_ACTION_STOP, SMALL_BEHAVIOUR_NEAR, 2U, NULL, 0U},
  {SMALL_ACTION_BEEP, SMALL_BEHAVIOUR_BEHAVIOUR_2, 2U, arguments_2, 5U}
};

static void behave_near(small_monitor *m)
{
  const small_verdict condition = m->e_r;
  const bool held = (m->near_condition == SMALL_TRUE);
  const bool rises = (condition == SMALL_TRUE) && (!held);
  m->near_condition = condition;
  /* 3 lines of smallest */
  behave_behaviour_2(m);
  if (rises) {
    small_emit(m->owner, m->now, SMALL_TRIGGER, 1U);  /* stop */
  }
}
