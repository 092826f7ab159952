/* What a host set a pseudo terminal to. */
#ifndef FIO_STANDIN_TERMINAL_RATE_H
#define FIO_STANDIN_TERMINAL_RATE_H

#include <stdint.h>

/* In bits/s, also one without a name, or with a name that was set by its number; 0: not known. */
int64_t fio_terminal_rate(int file);

#endif
