/* A file that appears whole or not at all: written beside its place, fsynced, renamed.
 *
 * "-" is standard output; it, a pipe or a device get their first byte at iso_output_commit(), once
 * the job is known to be good. */
#ifndef ISO_BASE_OUTPUT_H
#define ISO_BASE_OUTPUT_H

#include <stddef.h>
#include <stdint.h>

#include <isoslice/status.h>

typedef struct iso_output iso_output;

iso_status iso_output_open(iso_output **output, const char *path) ISO_MUST_CHECK;

/* Append bytes. A failure is kept and returned by commit, so that writers in loops may ignore it.
 */
iso_status iso_output_write(iso_output *output, const void *bytes, size_t size);
iso_status iso_output_print(iso_output *output, const char *format, ...) ISO_PRINTF(2, 3);
int64_t iso_output_size(const iso_output *output);

/* Replace `size` bytes written earlier, from byte `offset` on. A failure is kept, as above. */
iso_status iso_output_patch(iso_output *output, int64_t offset, const void *bytes, size_t size);

/* Put the file in its place, or fail and leave whatever was there before. Frees the output either
 * way. */
iso_status iso_output_commit(iso_output *output) ISO_MUST_CHECK;

/* Forget it all. NULL is allowed. */
void iso_output_abandon(iso_output *output);

/* Async-signal-safe: remove the unfinished file, if there is one. */
void iso_output_remove_unfinished(void);

#endif
