/* A serial device of the kernel's, or a pseudo terminal. */
#ifndef FIO_TRANSPORT_TTY_H
#define FIO_TRANSPORT_TTY_H

#include <isoprint/transport.h>

/* Open `path` for us alone, raw, 8N1, at any rate the device can make. `keep_lines`: DTR and RTS
 * are not touched here and do not fall at the end; the kernel itself raises them when it opens a
 * port that nobody left open so. FIO_NO_PRINTER with a message that says why and what to do. */
fio_status fio_tty_open(fio_transport **transport, const char *path, int64_t rate,
                        bool keep_lines) FIO_MUST_CHECK;

/* Why `path` could not be opened (an errno) and what to do about it. */
void fio_tty_explain(char *text, size_t capacity, const char *path, int error);

#endif
