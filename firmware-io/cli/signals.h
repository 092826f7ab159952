/* Signals as bytes of a pipe, so that one loop hears of them as of everything else. */
#ifndef FIO_CLI_SIGNALS_H
#define FIO_CLI_SIGNALS_H

#include <isoprint/status.h>

/* From now on SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGCONT and SIGWINCH do nothing but come
 * out of fio_signals_next(); those that were ignored stay so. SIGPIPE, SIGTTIN and SIGTTOU are
 * ignored. What a defect ends (SIGSEGV and the like) gives the terminal back first. */
fio_status fio_signals_catch(void) FIO_MUST_CHECK;

/* To be polled for reading. */
int fio_signals_descriptor(void);

/* The next one that came, 0 if there is none. */
int fio_signals_next(void);

/* Stop like a program that never caught SIGTSTP, until SIGCONT. */
void fio_signals_stop(void);

/* While nothing runs yet: FIO_CANCELLED if one came that ends a program; a stop is obeyed. */
fio_status fio_signals_check(void) FIO_MUST_CHECK;

#endif
