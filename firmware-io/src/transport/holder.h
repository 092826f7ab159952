/* Who has a port open. */
#ifndef FIO_TRANSPORT_HOLDER_H
#define FIO_TRANSPORT_HOLDER_H

#include <stdbool.h>
#include <stddef.h>

/* "octoprint (process 1234)": another process that has the device node `path` open, as far as we
 * may look: of other users' processes only root sees it. False if none is found. */
bool fio_holder_find(char *text, size_t capacity, const char *path);

#endif
