/* The terminal someone sits at: single keys from it, and its width. */
#ifndef FIO_CLI_TERMINAL_H
#define FIO_CLI_TERMINAL_H

#include <stdbool.h>

/* Take keys from standard input if that is a terminal; from the controlling terminal if standard
 * input is something else and `even_so`. In the background nothing is taken until
 * fio_terminal_continue(). However the program ends, the terminal is as it was. */
void fio_terminal_keys(bool even_so);

/* To be polled for reading; -1 if there are no keys. */
int fio_terminal_descriptor(void);

/* The next key, 0 if there is none. Arrows and the like are passed over. A terminal that is gone
 * gives none for ever. */
int fio_terminal_key(void);

/* As it was before; safe in a signal handler. Keys come again after fio_terminal_continue(). */
void fio_terminal_restore(void);
void fio_terminal_continue(void);

/* Of the terminal behind a descriptor; 80 if it doesn't say. */
int fio_terminal_columns(int descriptor);

/* Ask a question of someone at a terminal; false if there is nobody, or the answer is no. */
bool fio_terminal_confirm(const char *question);

#endif
