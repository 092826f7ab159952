#include "output.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* Writes no longer than this fit wherever poll() says that there is room in a pipe. */
enum { PIECE = 4096 };

static void reset(fio_output *output, int descriptor, bool owned) {
    struct stat about;
    output->descriptor = descriptor;
    output->owned = owned;
    output->error = 0;
    output->dropped = 0;
    output->first = output->length = 0;
    bool known = descriptor >= 0 && fstat(descriptor, &about) == 0;
    output->is_file = known && (S_ISREG(about.st_mode) || S_ISBLK(about.st_mode));
    output->is_socket = known && S_ISSOCK(about.st_mode);
}

void fio_output_share(fio_output *output, int descriptor) {
    reset(output, descriptor, false);
    if (output->is_file || output->is_socket)
        return;
    /* O_NONBLOCK belongs to the open file, which a shell and others share: open it anew. Where that
     * is not allowed, poll() before each piece has to do. */
    char path[32];
    snprintf(path, sizeof path, "/proc/self/fd/%d", descriptor);
    int own = open(path, O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (own >= 0)
        reset(output, own, true);
}

fio_status fio_output_create(fio_output *output, const char *path) {
    int descriptor = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_NOCTTY | O_CLOEXEC, 0666);
    if (descriptor < 0) {
        reset(output, -1, false);
        return fio_fail(FIO_NOT_WRITTEN, "%s: can't be written: %s", path, strerror(errno));
    }
    fio_output_share(output, descriptor);
    if (output->descriptor == descriptor)
        output->owned = true;
    else
        close(descriptor);
    return FIO_OK;
}

/* Bytes written, 0 if that would wait, -1 if it never works again. */
static ssize_t write_piece(fio_output *output, const char *bytes, size_t size) {
    if (!output->is_file) {
        struct pollfd poll_it = {output->descriptor, POLLOUT, 0};
        if (poll(&poll_it, 1, 0) != 1)
            return 0;
        size = size < PIECE ? size : PIECE;
    }
    ssize_t done = output->is_socket
                       ? send(output->descriptor, bytes, size, MSG_DONTWAIT | MSG_NOSIGNAL)
                       : write(output->descriptor, bytes, size);
    if (done >= 0)
        return done;
    if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)
        return 0;
    output->error = errno;
    return -1;
}

void fio_output_flush(fio_output *output) {
    while (output->length > 0 && !output->error) {
        size_t until_end = sizeof output->bytes - output->first;
        size_t size = output->length < until_end ? output->length : until_end;
        ssize_t done = write_piece(output, output->bytes + output->first, size);
        if (done <= 0)
            break;
        output->first = (output->first + (size_t)done) % sizeof output->bytes;
        output->length -= (size_t)done;
    }
}

void fio_output_line(fio_output *output, const char *bytes, size_t size) {
    if (output->descriptor < 0 || output->error)
        return;
    if (size > sizeof output->bytes - output->length)
        fio_output_flush(output);
    if (size > sizeof output->bytes - output->length) {
        output->dropped++;
        return;
    }
    for (size_t i = 0; i < size;) {
        size_t at = (output->first + output->length + i) % sizeof output->bytes;
        size_t room = sizeof output->bytes - at;
        size_t part = size - i < room ? size - i : room;
        memcpy(output->bytes + at, bytes + i, part);
        i += part;
    }
    output->length += size;
    if (!output->is_file || output->length > sizeof output->bytes / 2)
        fio_output_flush(output);
}

bool fio_output_waits(const fio_output *output, struct pollfd *poll) {
    *poll = (struct pollfd){output->descriptor, POLLOUT, 0};
    return output->length > 0 && !output->is_file && !output->error;
}

static double seconds_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

bool fio_output_close(fio_output *output, double seconds) {
    double end = seconds_now() + seconds;
    struct pollfd poll_it;
    fio_output_flush(output);
    while (fio_output_waits(output, &poll_it) && seconds_now() < end) {
        poll(&poll_it, 1, 20);
        fio_output_flush(output);
    }
    bool whole = output->length == 0 && !output->error && output->dropped == 0;
    if (output->owned && close(output->descriptor) != 0 && !output->error) {
        output->error = errno;
        whole = false;
    }
    output->descriptor = -1;
    output->owned = false;
    output->length = 0;
    return whole;
}
