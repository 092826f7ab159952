/* A job from the first look at the file to the last word about it; and all that uses a printer
 * without one. */
#ifndef FIO_CLI_PRINT_H
#define FIO_CLI_PRINT_H

#include "connection.h"

/* Print, or write to the card, arguments->file. */
fio_status fio_print_run(const fio_arguments *arguments, fio_control *control) FIO_MUST_CHECK;

/* --send and --console. FIO_FAULTY if the printer refused a command of --send. */
fio_status fio_print_commands(const fio_arguments *arguments, fio_control *control) FIO_MUST_CHECK;

#endif
