/* Lets calls of a program fail, by LD_PRELOAD. CLSHADE_FAULT says which and how:
 *
 *   disk:N:ERROR[:once]   after N calls that write below CLSHADE_FAULT_FOLDER: ENOSPC, EIO, EDQUOT
 *   kill:N                SIGKILL in place of the call N + 1 that writes there
 *   stop:N                SIGSTOP before that call
 *   device:N              after N kernels: CL_DEVICE_NOT_AVAILABLE, from every call that needs the device
 *   count:0               nothing, but the calls that write are counted
 *
 * Failures last, but for `once`. CLSHADE_FAULT_COUNT names a file to which the number of calls is written at the end.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

enum kind { none, disk, killing, stopping, device };
static enum kind kind = none;
static long after = 0;
static int error_number = ENOSPC;
static int once = 0;
static const char* folder = "";
static atomic_long calls = 0;

__attribute__((constructor)) static void begin(void) {
    const char* fault = getenv("CLSHADE_FAULT");
    const char* below = getenv("CLSHADE_FAULT_FOLDER");
    char name[16] = "";
    char error[16] = "";
    char last[16] = "";
    if (below != NULL) {
        folder = below;
    }
    if (fault == NULL || sscanf(fault, "%15[a-z]:%ld:%15[A-Z]:%15[a-z]", name, &after, error, last) < 2) {
        return;
    }
    kind = strcmp(name, "disk") == 0     ? disk
           : strcmp(name, "kill") == 0   ? killing
           : strcmp(name, "stop") == 0   ? stopping
           : strcmp(name, "device") == 0 ? device
                                         : none;
    error_number = strcmp(error, "EIO") == 0 ? EIO : strcmp(error, "EDQUOT") == 0 ? EDQUOT : ENOSPC;
    once = strcmp(last, "once") == 0;
}

__attribute__((destructor)) static void end(void) {
    const char* count = getenv("CLSHADE_FAULT_COUNT");
    FILE* file = count == NULL ? NULL : fopen(count, "w");
    if (file != NULL) {
        fprintf(file, "%ld\n", atomic_load(&calls));
        fclose(file);
    }
}

/* Counts a call; 1 if it must fail. */
static int strikes(enum kind of) {
    const enum kind counted = kind == device ? device : disk;
    if (of != counted) {
        return 0;
    }
    const long number = atomic_fetch_add(&calls, 1);
    if (kind == none || number < after || (once && number > after)) {
        return 0;
    }
    if (kind == killing) {
        kill(getpid(), SIGKILL);
        pause();
    }
    if (kind == stopping) {
        if (number == after) {
            kill(getpid(), SIGSTOP);
        }
        return 0;
    }
    errno = error_number;
    return 1;
}

static int is_below(const char* path) {
    return path != NULL && folder[0] != '\0' && strncmp(path, folder, strlen(folder)) == 0;
}

static int path_fails(const char* path) {
    return is_below(path) && strikes(disk);
}

static int descriptor_fails(int descriptor) {
    char link[64];
    char path[PATH_MAX];
    snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    const ssize_t length = readlink(link, path, sizeof path - 1);
    if (length < 0) {
        return 0;
    }
    path[length] = '\0';
    return path_fails(path);
}

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

ssize_t write(int d, const void* data, size_t size) {
    return descriptor_fails(d) ? -1 : NEXT(write)(d, data, size);
}
ssize_t pwrite(int d, const void* data, size_t size, off_t at) {
    return descriptor_fails(d) ? -1 : NEXT(pwrite)(d, data, size, at);
}
ssize_t pwrite64(int d, const void* data, size_t size, off64_t at) {
    return descriptor_fails(d) ? -1 : NEXT(pwrite64)(d, data, size, at);
}
ssize_t writev(int d, const struct iovec* data, int count) {
    return descriptor_fails(d) ? -1 : NEXT(writev)(d, data, count);
}
ssize_t pwritev(int d, const struct iovec* data, int count, off_t at) {
    return descriptor_fails(d) ? -1 : NEXT(pwritev)(d, data, count, at);
}
int ftruncate(int d, off_t size) {
    return descriptor_fails(d) ? -1 : NEXT(ftruncate)(d, size);
}
int fallocate(int d, int mode, off_t at, off_t size) {
    return descriptor_fails(d) ? -1 : NEXT(fallocate)(d, mode, at, size);
}
int posix_fallocate(int d, off_t at, off_t size) {
    return descriptor_fails(d) ? error_number : NEXT(posix_fallocate)(d, at, size);
}
int fsync(int d) {
    return descriptor_fails(d) ? -1 : NEXT(fsync)(d);
}
int fdatasync(int d) {
    return descriptor_fails(d) ? -1 : NEXT(fdatasync)(d);
}
int rename(const char* from, const char* to) {
    return path_fails(to) ? -1 : NEXT(rename)(from, to);
}
int renameat2(int a, const char* from, int b, const char* to, unsigned flags) {
    return path_fails(to) ? -1 : NEXT(renameat2)(a, from, b, to, flags);
}
int link(const char* from, const char* to) {
    return path_fails(to) ? -1 : NEXT(link)(from, to);
}

#define OPEN(name)                                                                                                     \
    int name(const char* path, int flags, ...) {                                                                       \
        va_list list;                                                                                                  \
        va_start(list, flags);                                                                                         \
        const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(list, mode_t) : 0;                           \
        va_end(list);                                                                                                  \
        return (flags & O_CREAT) != 0 && path_fails(path) ? -1 : NEXT(name)(path, flags, mode);                        \
    }
OPEN(open)
OPEN(open64)

/* OpenCL: the first four arguments are all that differ in meaning here; the others are handed on. */
#define CL_DEVICE_NOT_AVAILABLE (-2)
typedef void* handle;
static atomic_int lost = 0;

int clEnqueueNDRangeKernel(handle queue, handle kernel, unsigned dimensions, const size_t* offset, const size_t* global,
                           const size_t* local, unsigned waits, const handle* list, handle* event) {
    if (strikes(device)) {
        atomic_store(&lost, 1);
        return CL_DEVICE_NOT_AVAILABLE;
    }
    return NEXT(clEnqueueNDRangeKernel)(queue, kernel, dimensions, offset, global, local, waits, list, event);
}
int clFinish(handle queue) {
    return atomic_load(&lost) ? CL_DEVICE_NOT_AVAILABLE : NEXT(clFinish)(queue);
}
int clWaitForEvents(unsigned count, const handle* list) {
    return atomic_load(&lost) ? CL_DEVICE_NOT_AVAILABLE : NEXT(clWaitForEvents)(count, list);
}
handle clEnqueueMapBuffer(handle queue, handle buffer, unsigned blocking, unsigned long flags, size_t offset,
                          size_t size, unsigned waits, const handle* list, handle* event, int* error) {
    if (atomic_load(&lost)) {
        if (error != NULL) {
            *error = CL_DEVICE_NOT_AVAILABLE;
        }
        return NULL;
    }
    return NEXT(clEnqueueMapBuffer)(queue, buffer, blocking, flags, offset, size, waits, list, event, error);
}
int clEnqueueReadBuffer(handle queue, handle buffer, unsigned blocking, size_t offset, size_t size, void* data,
                        unsigned waits, const handle* list, handle* event) {
    return atomic_load(&lost)
               ? CL_DEVICE_NOT_AVAILABLE
               : NEXT(clEnqueueReadBuffer)(queue, buffer, blocking, offset, size, data, waits, list, event);
}
int clEnqueueWriteBuffer(handle queue, handle buffer, unsigned blocking, size_t offset, size_t size, const void* data,
                         unsigned waits, const handle* list, handle* event) {
    return atomic_load(&lost)
               ? CL_DEVICE_NOT_AVAILABLE
               : NEXT(clEnqueueWriteBuffer)(queue, buffer, blocking, offset, size, data, waits, list, event);
}
