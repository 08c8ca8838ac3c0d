// Refuses threads to one process, by LD_PRELOAD: while the file named by THREADS_REFUSED exists, none
// can be made, as where the limit of the user or of a control group is reached.

#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef int (*create)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);

static const char *flag;
static create real_create;

// Libraries may make threads before the constructors of this one are run: so it is done by whoever
// comes first.
__attribute__((constructor)) static void set_up(void) {
  void *found = dlsym(RTLD_NEXT, "pthread_create");
  memcpy(&real_create, &found, sizeof real_create);
  flag = getenv("THREADS_REFUSED");
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *),
                   void *with) {
  if (!real_create) set_up();
  if (flag && access(flag, F_OK) == 0) return EAGAIN;
  return real_create(thread, attributes, run, with);
}
