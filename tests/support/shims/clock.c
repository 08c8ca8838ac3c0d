// Steps the wall clock of one process, by LD_PRELOAD: CLOCK_REALTIME is off by as many seconds as
// the file named by WALL_CLOCK_OFFSET says, whenever it is asked. No other clock is touched. The file
// holds one number of 64 bits; it is mapped, so that whoever maps it, too, sets the clock by one store.
//
// What tells the time may be called by signal handlers, on alternate stacks of a few kilobytes: it
// adds that number and calls nothing else. Waits may not be called there, nor may the real ones.
//
// The kernel does not know of the step, but it would end or prolong the waits until a time of the
// wall clock when the real one is set. So a thread looks at the file, and has such waits on condition
// variables started anew, but for those that somebody else has ended meanwhile: that is told once only.
// Waits on semaphores and locks, which forget nothing, are cut into short ones.

#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#define SLICE_NS 5000000L
#define OLDEST_WALL_TIME 1000000000L  // seconds; no steady clock has come that far

static int (*real_clock_gettime)(clockid_t, struct timespec *);
static int (*real_cond_timedwait)(pthread_cond_t *, pthread_mutex_t *, const struct timespec *);
static int (*real_cond_signal)(pthread_cond_t *);
static int (*real_cond_broadcast)(pthread_cond_t *);
static int (*real_cond_clockwait)(pthread_cond_t *, pthread_mutex_t *, clockid_t,
                                  const struct timespec *);
static int (*real_sem_timedwait)(sem_t *, const struct timespec *);
static int (*real_sem_clockwait)(sem_t *, clockid_t, const struct timespec *);
static int (*real_mutex_timedlock)(pthread_mutex_t *, const struct timespec *);
static const int64_t none;
static const volatile int64_t *set_offset = &none;

struct waiter {
  pthread_cond_t *condition;
  int is_told;
  struct waiter *next;
};

static struct waiter *waiters;
static pthread_mutex_t waiters_lock = PTHREAD_MUTEX_INITIALIZER;
static volatile long known_offset;

static long offset(void) { return (long)*set_offset; }

static void *watch(void *unused) {
  const struct timespec slice = {0, SLICE_NS};
  for (;;) {
    nanosleep(&slice, NULL);
    if (offset() == known_offset) continue;
    pthread_mutex_lock(&waiters_lock);
    known_offset = offset();
    for (struct waiter *each = waiters; each; each = each->next)
      real_cond_broadcast(each->condition);
    pthread_mutex_unlock(&waiters_lock);
  }
  return unused;
}

// Condition variables have had their form since glibc 2.3.2; x86-64 keeps the one before, too.
static void *of_condition_variables(const char *name) {
  void *found = dlvsym(RTLD_NEXT, name, "GLIBC_2.3.2");
  return found ? found : dlsym(RTLD_NEXT, name);
}

// Every signal is left to the threads of the process under test.
static void follow(const char *path) {
  int file = open(path, O_RDONLY | O_CLOEXEC);
  void *mapped = mmap(NULL, sizeof *set_offset, PROT_READ, MAP_SHARED, file, 0);
  if (mapped == MAP_FAILED) abort();
  close(file);
  set_offset = mapped;
  known_offset = offset();
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  pthread_t thread;
  pthread_create(&thread, NULL, watch, NULL);
  pthread_sigmask(SIG_SETMASK, &before, NULL);
}

__attribute__((constructor)) static void set_up(void) {
  real_clock_gettime = dlsym(RTLD_NEXT, "clock_gettime");
  real_cond_timedwait = of_condition_variables("pthread_cond_timedwait");
  real_cond_signal = of_condition_variables("pthread_cond_signal");
  real_cond_broadcast = of_condition_variables("pthread_cond_broadcast");
  real_cond_clockwait = dlsym(RTLD_NEXT, "pthread_cond_clockwait");
  real_sem_timedwait = dlsym(RTLD_NEXT, "sem_timedwait");
  real_sem_clockwait = dlsym(RTLD_NEXT, "sem_clockwait");
  real_mutex_timedlock = dlsym(RTLD_NEXT, "pthread_mutex_timedlock");
  const char *path = getenv("WALL_CLOCK_OFFSET");
  if (path && set_offset == &none) follow(path);
}

int clock_gettime(clockid_t clock, struct timespec *now) {
  if (!real_clock_gettime) set_up();  // asked before the constructors have run
  int result = real_clock_gettime(clock, now);
  if (clock == CLOCK_REALTIME && result == 0) now->tv_sec += offset();
  return result;
}

int gettimeofday(struct timeval *restrict now, void *restrict zone) {
  (void)zone;
  struct timespec precise;
  clock_gettime(CLOCK_REALTIME, &precise);
  now->tv_sec = precise.tv_sec;
  now->tv_usec = precise.tv_nsec / 1000;
  return 0;
}

time_t time(time_t *result) {
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  if (result) *result = now.tv_sec;
  return now.tv_sec;
}

// The end of the next short wait, in the kernel's time; 1 if `until` comes no later than that.
static int next_slice(const struct timespec *until, struct timespec *slice) {
  struct timespec kernel;
  real_clock_gettime(CLOCK_REALTIME, &kernel);
  *slice = kernel;
  slice->tv_nsec += SLICE_NS;
  if (slice->tv_nsec >= 1000000000L) {
    slice->tv_sec += 1;
    slice->tv_nsec -= 1000000000L;
  }
  struct timespec target = {until->tv_sec - offset(), until->tv_nsec};
  if (target.tv_sec > slice->tv_sec ||
      (target.tv_sec == slice->tv_sec && target.tv_nsec > slice->tv_nsec))
    return 0;
  *slice = target;
  return 1;
}

int pthread_cond_timedwait(pthread_cond_t *restrict condition, pthread_mutex_t *restrict mutex,
                           const struct timespec *restrict until) {
  if (until->tv_sec < OLDEST_WALL_TIME) return real_cond_timedwait(condition, mutex, until);
  pthread_mutex_lock(&waiters_lock);
  struct waiter self = {condition, 0, waiters};
  waiters = &self;
  int result;
  long believed;
  do {
    believed = known_offset;
    pthread_mutex_unlock(&waiters_lock);
    struct timespec target = {until->tv_sec - believed, until->tv_nsec};
    result = real_cond_timedwait(condition, mutex, &target);
    pthread_mutex_lock(&waiters_lock);
  } while (known_offset != believed && !self.is_told);
  struct waiter **link = &waiters;
  while (*link != &self) link = &(*link)->next;
  *link = self.next;
  pthread_mutex_unlock(&waiters_lock);
  return result;
}

static void tell(const pthread_cond_t *condition) {
  pthread_mutex_lock(&waiters_lock);
  for (struct waiter *each = waiters; each; each = each->next)
    if (each->condition == condition) each->is_told = 1;
  pthread_mutex_unlock(&waiters_lock);
}

int pthread_cond_signal(pthread_cond_t *condition) {
  if (!real_cond_signal) set_up();
  tell(condition);
  return real_cond_signal(condition);
}

int pthread_cond_broadcast(pthread_cond_t *condition) {
  if (!real_cond_broadcast) set_up();
  tell(condition);
  return real_cond_broadcast(condition);
}

int pthread_cond_clockwait(pthread_cond_t *condition, pthread_mutex_t *mutex, clockid_t clock,
                           const struct timespec *until) {
  if (clock != CLOCK_REALTIME) return real_cond_clockwait(condition, mutex, clock, until);
  return pthread_cond_timedwait(condition, mutex, until);
}

int sem_timedwait(sem_t *restrict semaphore, const struct timespec *restrict until) {
  for (;;) {
    struct timespec slice;
    int last = next_slice(until, &slice);
    int result = real_sem_timedwait(semaphore, &slice);
    if (result == 0 || errno != ETIMEDOUT || last) return result;
  }
}

int sem_clockwait(sem_t *restrict semaphore, clockid_t clock, const struct timespec *restrict until) {
  if (clock != CLOCK_REALTIME) return real_sem_clockwait(semaphore, clock, until);
  return sem_timedwait(semaphore, until);
}

int pthread_mutex_timedlock(pthread_mutex_t *restrict mutex, const struct timespec *restrict until) {
  for (;;) {
    struct timespec slice;
    int last = next_slice(until, &slice);
    int result = real_mutex_timedlock(mutex, &slice);
    if (result != ETIMEDOUT || last) return result;
  }
}
