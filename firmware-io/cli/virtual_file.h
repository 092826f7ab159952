/* isoprint-virtual --run: a file straight into the printer. */
#ifndef FIO_CLI_VIRTUAL_FILE_H
#define FIO_CLI_VIRTUAL_FILE_H

#include <stdio.h>

#include "virtual_options.h"

fio_status virtual_file_run(const virtual_arguments *given,
                            const fio_execution_log *log) FIO_MUST_CHECK;

#endif
