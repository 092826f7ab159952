/* A job's G-code, command by command, from a file, a pipe or memory; any bytes in any pieces. */
#ifndef FIO_PROTOCOL_SOURCE_H
#define FIO_PROTOCOL_SOURCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <isoprint/status.h>

enum { FIO_COMMAND_MOST = 4095 }; /* bytes of a line; a longer one is an error of the file */

typedef struct fio_source_command {
    const char *text; /* no comment, no blanks around it, no N, no checksum; ends with a 0 */
    size_t length;    /* > 0 */
    int64_t index;    /* 0 = the first command of the file */
    int64_t line;     /* 1 = the first line of the file */
    int64_t offset;   /* of the first byte after this line */
    int32_t layer;    /* 0 = before the first ;LAYER_CHANGE (or ;LAYER:) comment */
} fio_source_command;

typedef enum fio_source_result {
    FIO_SOURCE_COMMAND,
    FIO_SOURCE_LATER, /* nothing there yet (a pipe); ask again when its descriptor is readable */
    FIO_SOURCE_END,
    FIO_SOURCE_FAILED /* fio_error_message() says where and why */
} fio_source_result;

typedef struct fio_source fio_source;

/* Of the whole job, as far as it is known: -1 otherwise. */
typedef struct fio_source_summary {
    int64_t bytes;
    int32_t layers; /* counted beforehand in a file, never in a pipe */
    double seconds; /* "; estimated printing time (normal mode) = …", or Cura's ;TIME: */
} fio_source_summary;

/* `path` "-" is standard input, read without waiting. Memory does not grow with the job. */
fio_status fio_source_open(fio_source **source, const char *path) FIO_MUST_CHECK;
/* `bytes` stays the caller's and must outlive the source. */
fio_status fio_source_memory(fio_source **source, const char *bytes, size_t size) FIO_MUST_CHECK;
void fio_source_close(fio_source *source); /* NULL is fine */

/* The next command; valid until the next call. */
fio_source_result fio_source_next(fio_source *source, fio_source_command *command);

/* Go on with the command of this index. Files and memory only. */
fio_status fio_source_seek(fio_source *source, int64_t index) FIO_MUST_CHECK;

int fio_source_descriptor(
    const fio_source *source); /* to poll; -1 if it never has to be waited for */
const fio_source_summary *fio_source_whole(const fio_source *source);

/* Length and the hash of its first and last 64 KiB: whether a file is still the same. */
uint64_t fio_source_fingerprint(const fio_source *source);

#endif
