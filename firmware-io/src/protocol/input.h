/* Bytes of a job: a file, a pipe that is never waited for, or memory. */
#ifndef FIO_PROTOCOL_INPUT_H
#define FIO_PROTOCOL_INPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <isoprint/status.h>

typedef struct fio_input {
    int descriptor; /* -1: memory */
    bool own;       /* to be closed */
    bool seekable;  /* a file or memory */
    const char *memory;
    int64_t size, start, at; /* of what is seekable: bytes from `start`, of which `at` were read */
    char name[256];          /* for messages */
} fio_input;

fio_status fio_input_open(fio_input *input, const char *path) FIO_MUST_CHECK;
void fio_input_memory(fio_input *input, const char *bytes, size_t size);
void fio_input_close(fio_input *input);

/* The next bytes: their number, 0 at the end, FIO_INPUT_LATER, or FIO_INPUT_FAILED with a message.
 */
enum { FIO_INPUT_LATER = -1, FIO_INPUT_FAILED = -2 };
int64_t fio_input_read(fio_input *input, char *bytes, size_t capacity);

/* Bytes from anywhere in what is seekable; fewer than asked for at its end or if it can't be read.
 */
size_t fio_input_look(const fio_input *input, int64_t from, char *bytes, size_t capacity);

#endif
