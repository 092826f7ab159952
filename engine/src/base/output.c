#include "base/output.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"

enum { BUFFER_SIZE = 64 << 10 };

struct iso_output {
    int descriptor;
    iso_status status;
    int64_t size;
    size_t buffered;
    int target; /* >= 0: standard output, a pipe or a device, which gets everything at commit */
    char *path; /* as given */
    char *temporary; /* beside it */
    char buffer[BUFFER_SIZE];
};

/* At most one file is being written; a signal handler may read this. */
static char *volatile unfinished;

void iso_output_remove_unfinished(void) {
    if (unfinished)
        unlink(unfinished);
}

static iso_status not_written(const char *path) {
    return iso_fail(ISO_NOT_WRITTEN, "%s: can't be written: %s", path, strerror(errno));
}

static void output_free(iso_output *output) {
    if (output->descriptor >= 0)
        close(output->descriptor);
    if (output->target >= 0)
        close(output->target);
    iso_release(output->path);
    iso_release(output->temporary);
    iso_release(output);
}

/* Make the file and name it for iso_output_remove_unfinished; a signal comes before both or after
 * both. */
static int make_unfinished(iso_output *output) {
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    output->descriptor = mkstemp(output->temporary);
    int error = errno;
    if (output->descriptor >= 0)
        unfinished = output->temporary;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    errno = error;
    return output->descriptor >= 0;
}

/* mkstemp gives 0600; a file of ours has the mode any other program would give it */
static void set_usual_mode(int descriptor) {
    mode_t mask = umask(0);
    umask(mask);
    (void)!fchmod(descriptor, 0666 & ~mask);
}

static iso_status copy_path(iso_output *output, const char *path) {
    size_t size = strlen(path) + 1;
    output->path = iso_allocate(size);
    if (!output->path)
        return iso_no_memory(size);
    memcpy(output->path, path, size);
    return ISO_OK;
}

static iso_status open_beside(iso_output *output, const char *path) {
    size_t length = strlen(path);
    ISO_TRY(copy_path(output, path));
    output->temporary = iso_allocate(length + 8);
    if (!output->temporary)
        return iso_no_memory(length + 8);
    snprintf(output->temporary, length + 8, "%s.XXXXXX", path);
    if (!make_unfinished(output))
        return not_written(path);
    set_usual_mode(output->descriptor);
    return ISO_OK;
}

/* What can't be replaced by a rename is written in one go at the end. */
static iso_status open_scratch(iso_output *output, const char *path) {
    output->target = strcmp(path, "-") == 0 ? dup(STDOUT_FILENO) : open(path, O_WRONLY);
    if (output->target < 0)
        return not_written(path);
    if (strcmp(path, "-") != 0)
        ISO_TRY(copy_path(output, path));
    FILE *scratch = tmpfile();
    if (!scratch)
        return not_written(path);
    output->descriptor = dup(fileno(scratch));
    fclose(scratch);
    return output->descriptor < 0 ? not_written(path) : ISO_OK;
}

iso_status iso_output_open(iso_output **out, const char *path) {
    *out = NULL;
    iso_output *output = iso_allocate(sizeof *output);
    if (!output)
        return iso_no_memory(sizeof *output);
    memset(output, 0, offsetof(iso_output, buffer));
    output->descriptor = output->target = -1;
    struct stat there;
    int exists = strcmp(path, "-") != 0 && stat(path, &there) == 0;
    iso_status status;
    if (exists && S_ISDIR(there.st_mode))
        status = iso_fail(ISO_NOT_WRITTEN, "%s: is a directory; give the name of a file", path);
    else if (strcmp(path, "-") == 0 || (exists && !S_ISREG(there.st_mode)))
        status = open_scratch(output, path);
    else
        status = open_beside(output, path);
    if (status != ISO_OK) {
        output_free(output);
        return status;
    }
    *out = output;
    return ISO_OK;
}

static iso_status write_all(int descriptor, const char *bytes, size_t size, const char *path) {
    while (size > 0) {
        ssize_t n = write(descriptor, bytes, size);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return not_written(path);
        bytes += n;
        size -= (size_t)n;
    }
    return ISO_OK;
}

static const char *output_name(const iso_output *output) {
    return !output->path ? "standard output" : output->path;
}

static iso_status flush(iso_output *output) {
    if (output->status == ISO_OK)
        output->status =
            write_all(output->descriptor, output->buffer, output->buffered, output_name(output));
    output->buffered = 0;
    return output->status;
}

iso_status iso_output_write(iso_output *output, const void *bytes, size_t size) {
    output->size += (int64_t)size;
    if (output->buffered + size > BUFFER_SIZE)
        flush(output);
    if (size > BUFFER_SIZE) {
        if (output->status == ISO_OK)
            output->status = write_all(output->descriptor, bytes, size, output_name(output));
        return output->status;
    }
    memcpy(output->buffer + output->buffered, bytes, size);
    output->buffered += size;
    return output->status;
}

iso_status iso_output_print(iso_output *output, const char *format, ...) {
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    int n = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (n < 0 || (size_t)n >= sizeof text)
        return output->status = iso_fail(ISO_BUG, "a line of %d bytes is too long to print", n);
    return iso_output_write(output, text, (size_t)n);
}

int64_t iso_output_size(const iso_output *output) {
    return output->size;
}

iso_status iso_output_patch(iso_output *output, int64_t offset, const void *bytes, size_t size) {
    if (offset < 0 || offset + (int64_t)size > output->size)
        return output->status = iso_fail(ISO_BUG, "a patch beyond the end of the output");
    int64_t flushed = output->size - (int64_t)output->buffered;
    if (offset >= flushed) {
        memcpy(output->buffer + (offset - flushed), bytes, size);
        return output->status;
    }
    ISO_TRY(flush(output));
    if (pwrite(output->descriptor, bytes, size, (off_t)offset) != (ssize_t)size)
        output->status = not_written(output_name(output));
    return output->status;
}

static iso_status copy_to_target(iso_output *output) {
    if (lseek(output->descriptor, 0, SEEK_SET) < 0)
        return not_written(output_name(output));
    for (;;) {
        ssize_t n = read(output->descriptor, output->buffer, BUFFER_SIZE);
        if (n < 0)
            return not_written(output_name(output));
        if (n == 0)
            return ISO_OK;
        ISO_TRY(write_all(output->target, output->buffer, (size_t)n, output_name(output)));
    }
}

/* The rename itself reaches the disk when its directory does. A file system that can't sync a
 * directory is no reason to fail. */
static void sync_directory(char *path) {
    int descriptor = open(dirname(path), O_RDONLY);
    if (descriptor < 0)
        return;
    (void)fsync(descriptor);
    close(descriptor);
}

static iso_status put_in_place(iso_output *output) {
    if (fsync(output->descriptor) != 0 && errno != EINVAL)
        return not_written(output->path);
    if (rename(output->temporary, output->path) != 0)
        return not_written(output->path);
    unfinished = NULL;
    sync_directory(output->temporary);
    return ISO_OK;
}

iso_status iso_output_commit(iso_output *output) {
    iso_status status = flush(output);
    if (status == ISO_OK)
        status = output->target >= 0 ? copy_to_target(output) : put_in_place(output);
    if (status != ISO_OK) {
        iso_output_abandon(output);
        return status;
    }
    output_free(output);
    return ISO_OK;
}

void iso_output_abandon(iso_output *output) {
    if (!output)
        return;
    if (output->temporary && output->descriptor >= 0)
        unlink(output->temporary);
    unfinished = NULL;
    output_free(output);
}
