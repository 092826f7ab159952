/* A job's G-code, command by command, from a file, a pipe or memory; any bytes in any pieces.
 *
 * Comments (from ';' to the end, and in parentheses), blanks around commands, line numbers,
 * checksums, a byte order mark and lines of a lone '%' are left out. Lines end with LF, CR or both.
 * A byte below ' ' other than a tab in a command (binary data) and a command of more than
 * FIO_COMMAND_MOST bytes are errors; comments may hold anything and be of any length. */
#ifndef FIO_PROTOCOL_SOURCE_H
#define FIO_PROTOCOL_SOURCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <isoprint/status.h>

enum { FIO_COMMAND_MOST = 4095 }; /* bytes of a command; a longer one is an error of the file */

typedef struct fio_source_command {
    const char *text; /* no comment, no blanks around it, no N, no checksum; ends with a 0 */
    size_t length;    /* > 0 */
    int64_t index;    /* 0 = the first command of the file */
    int64_t line;     /* 1 = the first line of the file */
    int64_t offset;   /* of the first byte after this line */
    int32_t layer;    /* 0 = before the first ;LAYER_CHANGE (or ;LAYER: or ; CHANGE_LAYER) */
} fio_source_command;

typedef enum fio_source_result {
    FIO_SOURCE_COMMAND,
    FIO_SOURCE_LATER, /* nothing there yet (a pipe); ask again when its descriptor is readable */
    FIO_SOURCE_END,
    FIO_SOURCE_FAILED /* fio_error_message() says where and why; again at each further call */
} fio_source_result;

typedef struct fio_source fio_source;

/* Of the whole job, as far as it is known: -1 otherwise. */
typedef struct fio_source_summary {
    int64_t bytes;
    int32_t layers; /* counted ahead in a file (a large one's are known some time after the start);
                     * in a pipe only if the slicer tells */
    double seconds; /* "; estimated printing time (normal mode) = …" and the like, Cura's ;TIME:,
                     * else the first M73 R */
} fio_source_summary;

/* `path` "-" is standard input, read without waiting (its flags stay as they are). Memory does not
 * grow with the job: 330 KB. FIO_UNREADABLE, FIO_NO_MEMORY. Reads up to 64 MB of a file. */
fio_status fio_source_open(fio_source **source, const char *path) FIO_MUST_CHECK;
/* `bytes` stays the caller's and must outlive the source. */
fio_status fio_source_memory(fio_source **source, const char *bytes, size_t size) FIO_MUST_CHECK;
void fio_source_close(fio_source *source); /* NULL is fine */

/* The next command; valid until the next call. */
fio_source_result fio_source_next(fio_source *source, fio_source_command *command);

/* Go on with the command of this index; that behind the last one is the end. Files and memory only,
 * else FIO_USAGE, as for an index beyond. Reads from the beginning if it goes back. */
fio_status fio_source_seek(fio_source *source, int64_t index) FIO_MUST_CHECK;

/* To poll; -1 if it never has to be waited for. */
int fio_source_descriptor(const fio_source *source);
const fio_source_summary *fio_source_whole(const fio_source *source);

/* Length and the hash of its first and last 64 KiB: whether a file is still the same. 0: a pipe. */
uint64_t fio_source_fingerprint(const fio_source *source);

#endif
