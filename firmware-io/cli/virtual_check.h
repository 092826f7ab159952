/* Whether what a printer executed is a G-code file: each of its lines once, in order, and nothing
 * else but what hosts say for themselves. */
#ifndef FIO_CLI_VIRTUAL_CHECK_H
#define FIO_CLI_VIRTUAL_CHECK_H

#include <stdbool.h>

#include <isoprint/virtual_printer.h>

typedef struct virtual_check virtual_check;

/* `host_commands`: more of those, parted by commas; NULL. FIO_UNREADABLE. */
fio_status virtual_check_open(virtual_check **check, const char *path,
                              const char *host_commands) FIO_MUST_CHECK;
void virtual_check_close(virtual_check *check); /* NULL is fine */

void virtual_check_entry(virtual_check *check, const fio_executed *executed);

/* The link was lost or the firmware reset: for some lines a host may now bring the printer back to
 * where it was. */
void virtual_check_interrupted(virtual_check *check);

/* After the last line: NULL, or what is the first difference. Valid until it is closed. */
const char *virtual_check_result(virtual_check *check);

#endif
