#include "protocol/input.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static fio_status failed_open(const char *path, const char *why) {
    return fio_fail(FIO_UNREADABLE, "%s can't be read: %s", path, why);
}

fio_status fio_input_open(fio_input *input, const char *path) {
    bool standard = strcmp(path, "-") == 0;
    /* A named pipe opens at once, though nobody may be writing to it yet. */
    int flags = O_RDONLY | O_CLOEXEC | O_NONBLOCK;
    *input =
        (fio_input){.descriptor = standard ? STDIN_FILENO : open(path, flags), .own = !standard};
    if (input->descriptor < 0)
        return failed_open(path, strerror(errno));
    snprintf(input->name, sizeof input->name, "%s", standard ? "standard input" : path);
    struct stat about;
    bool known = fstat(input->descriptor, &about) == 0;
    if (!known || S_ISDIR(about.st_mode)) {
        fio_status status = failed_open(input->name, known ? "it is a folder" : strerror(errno));
        fio_input_close(input);
        return status;
    }
    input->seekable = S_ISREG(about.st_mode);
    if (input->seekable) {
        off_t start = lseek(input->descriptor, 0, SEEK_CUR);
        input->start = start > 0 ? (int64_t)start : 0;
        input->size = about.st_size > input->start ? (int64_t)about.st_size - input->start : 0;
    }
    return FIO_OK;
}

void fio_input_memory(fio_input *input, const char *bytes, size_t size) {
    *input = (fio_input){
        .descriptor = -1, .seekable = true, .memory = bytes, .size = (int64_t)size, .name = "job"};
}

void fio_input_close(fio_input *input) {
    if (input->own && input->descriptor >= 0)
        close(input->descriptor);
    input->descriptor = -1;
}

static int64_t failed_read(const fio_input *input) {
    (void)!fio_fail(FIO_UNREADABLE, "%s can't be read on: %s", input->name, strerror(errno));
    return FIO_INPUT_FAILED;
}

static int64_t read_pipe(fio_input *input, char *bytes, size_t capacity) {
    /* Asking first leaves the descriptor's flags alone, which the shell and others share. */
    struct pollfd ready = {.fd = input->descriptor, .events = POLLIN};
    int count = poll(&ready, 1, 0);
    if (count < 0 && errno != EINTR)
        return failed_read(input);
    if (count <= 0)
        return FIO_INPUT_LATER;
    ssize_t got = read(input->descriptor, bytes, capacity);
    if (got < 0)
        return errno == EINTR || errno == EAGAIN ? FIO_INPUT_LATER : failed_read(input);
    return got;
}

int64_t fio_input_read(fio_input *input, char *bytes, size_t capacity) {
    if (!input->seekable)
        return read_pipe(input, bytes, capacity);
    if (input->descriptor < 0) {
        size_t got = fio_input_look(input, input->at, bytes, capacity);
        input->at += (int64_t)got;
        return (int64_t)got;
    }
    ssize_t got;
    do
        got = pread(input->descriptor, bytes, capacity, (off_t)(input->start + input->at));
    while (got < 0 && errno == EINTR);
    if (got < 0)
        return failed_read(input);
    input->at += got;
    return got;
}

size_t fio_input_look(const fio_input *input, int64_t from, char *bytes, size_t capacity) {
    if (!input->seekable || from < 0 || from >= input->size)
        return 0;
    if ((int64_t)capacity > input->size - from)
        capacity = (size_t)(input->size - from);
    if (input->descriptor < 0) {
        memcpy(bytes, input->memory + from, capacity);
        return capacity;
    }
    size_t got = 0;
    while (got < capacity) {
        ssize_t some = pread(input->descriptor, bytes + got, capacity - got,
                             (off_t)(input->start + from + (int64_t)got));
        if (some < 0 && errno == EINTR)
            continue;
        if (some <= 0)
            break;
        got += (size_t)some;
    }
    return got;
}
