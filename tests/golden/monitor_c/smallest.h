/*
 * The monitor of small: what its safety rules say of messages and of time.
… 3 lines of monitor.h.j2: *
 * be called while another one of the same monitor runs, small_emit() included.
 */
#ifndef SMALL_MONITOR_H_
#define SMALL_MONITOR_H_

… 9 lines of monitor.h.j2: #include <stdbool.h>
#define SMALL_MEMORY 48U

/* No time: of a deadline, that there is none. */
#define SMALL_NEVER INT64_MAX

/* The latest time of a monitor; a later time counts as this one, a negative one as 0. */
#define SMALL_LATEST (INT64_MAX / 2)

… 3 lines of monitor.h.j2: /* Kleene's three values, the less true before the truer. */
  SMALL_FALSE,
  SMALL_UNKNOWN,
  SMALL_TRUE
} small_verdict;

… 4 lines of monitor.h.j2: /* What has happened: an action is to be done, it is active no longer, it stays active although its
  SMALL_TRIGGER,
  SMALL_RESET,
  SMALL_REFUSED,
  SMALL_CLOCK_STEP
} small_kind;

typedef enum
{
  SMALL_ACTION_STOP
} small_action;

typedef enum
{
  SMALL_BEHAVIOUR_BEHAVIOUR_1,
  SMALL_BEHAVIOUR_NONE
} small_behaviour;

… 3 lines of monitor.h.j2: /* A place in the rules that emits events: a call in a behaviour, or an action's declaration. */
  small_action action;
  small_behaviour behaviour;
  uint32_t line;
} small_site;

#define SMALL_SITE_COUNT 1U
#define SMALL_SITE_NONE UINT32_MAX
extern const small_site small_sites[SMALL_SITE_COUNT];

… 3 lines of monitor.h.j2: /* A monitor; its fields are to be read only. Of a value that is not known, the field is stale. */
  void *owner;  /* handed on to the callback */
  int64_t now;  /* the instant of the last event, or later */
  int64_t due;  /* when to call advance at the latest */
  int64_t e_r_turned;  /* when it last became true or ceased to be */
  small_verdict e_r;  /* rule e.r */
  small_verdict behaviour_1_condition;  /* its condition and all around it */
  bool v_known;  /* whether v is known */
  bool v;  /* as of the last message */
  bool started;  /* whether there has been an event */
} small_monitor;

/* To be written by the owner: takes each event as it happens; site is SMALL_SITE_NONE
 * for a step of the clock, else a place in small_sites. It must not call the monitor. */
extern void small_emit(
  void *owner, int64_t t, small_kind kind, uint32_t site);

/* Begins at t; timeouts begin to count grace nanoseconds later. To be called before all else. */
void small_start(small_monitor *m, void *owner, int64_t t, int64_t grace);

/* Settles all that is due up to and including t. Returns when to be called next at the latest, if
 * nothing else is called before; maybe nothing turns out to be due then. */
int64_t small_advance(small_monitor *m, int64_t t);

/* Whether an input has yet to come for the first time, and is not missing yet. */
bool small_waiting(const small_monitor *m);

/* Takes a message of /flag (std_msgs/msg/Bool). */
void small_on_v(small_monitor *m, int64_t t, bool data);

… 4 lines of monitor.h.j2: #ifdef __cplusplus
#endif  /* SMALL_MONITOR_H_ */
