/* --dry-run: what a job would do, found out on the virtual printer. */
#ifndef FIO_CLI_CHECK_H
#define FIO_CLI_CHECK_H

#include "arguments.h"
#include "narrator.h"

/* FIO_FAULTY if it would do harm; the faults have been told then. */
fio_status fio_check_run(const fio_arguments *arguments, fio_narrator *narrator) FIO_MUST_CHECK;

#endif
