// A disk that fails, for tests: loaded before the C library (LD_PRELOAD), it lets the calls of one kind on files below a
// directory fail from the n-th on.
//
// PLICA_FAIL_BELOW   the directory
// PLICA_FAIL_CALL    write (a full disk: half of the n-th, nothing after it), fsync, rename, or open (for writing)
// PLICA_FAIL_FROM    n, from 1; 0: never
// PLICA_FAIL_COUNT   a file: how many such calls there were is written to it at the end
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/uio.h>
#include <unistd.h>

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static long calls;

static int is_below(const char* path) {
  const char* below = getenv("PLICA_FAIL_BELOW");
  return below && path && strncmp(path, below, strlen(below)) == 0;
}

static int is_open_below(int descriptor) {
  char link[64], path[PATH_MAX];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length <= 0) return 0;
  path[length] = 0;
  return is_below(path);
}

// How the call is to end: 0 as ever, 1 half of it, 2 not at all.
static int outcome(const char* call) {
  const char *failing = getenv("PLICA_FAIL_CALL"), *from = getenv("PLICA_FAIL_FROM");
  if (!failing || !from || strcmp(failing, call) != 0) return 0;
  const long first = atol(from);
  pthread_mutex_lock(&mutex);
  const long number = ++calls;
  pthread_mutex_unlock(&mutex);
  if (first <= 0 || number < first) return 0;
  return number == first ? 1 : 2;
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

ssize_t write(int descriptor, const void* bytes, size_t size) {
  const int how = is_open_below(descriptor) ? outcome("write") : 0;
  if (how == 1 && size > 1) return REAL(write)(descriptor, bytes, size / 2);
  if (how == 0) return REAL(write)(descriptor, bytes, size);
  errno = ENOSPC;
  return -1;
}

ssize_t writev(int descriptor, const struct iovec* parts, int count) {
  if (!is_open_below(descriptor) || outcome("write") == 0) return REAL(writev)(descriptor, parts, count);
  errno = ENOSPC;
  return -1;
}

ssize_t pwrite64(int descriptor, const void* bytes, size_t size, off64_t at) {
  if (!is_open_below(descriptor) || outcome("write") == 0) return REAL(pwrite64)(descriptor, bytes, size, at);
  errno = ENOSPC;
  return -1;
}

int fsync(int descriptor) {
  if (!is_open_below(descriptor) || outcome("fsync") == 0) return REAL(fsync)(descriptor);
  errno = EIO;
  return -1;
}

int rename(const char* from, const char* to) {
  if (!is_below(to) || outcome("rename") == 0) return REAL(rename)(from, to);
  errno = EIO;
  return -1;
}

static int open_as_told(const char* path, int flags, mode_t mode) {
  if ((flags & O_ACCMODE) == O_RDONLY || !is_below(path) || outcome("open") == 0) return REAL(open64)(path, flags, mode);
  errno = EROFS;
  return -1;
}

static mode_t mode_in(int flags, va_list list) { return (flags & (O_CREAT | O_TMPFILE)) ? va_arg(list, mode_t) : 0; }

int open(const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const mode_t mode = mode_in(flags, list);
  va_end(list);
  return open_as_told(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const mode_t mode = mode_in(flags, list);
  va_end(list);
  return open_as_told(path, flags, mode);
}

__attribute__((destructor)) static void tell(void) {
  const char* name = getenv("PLICA_FAIL_COUNT");
  FILE* file = name ? fopen(name, "w") : NULL;
  if (!file) return;
  fprintf(file, "%ld\n", calls);
  fclose(file);
}
