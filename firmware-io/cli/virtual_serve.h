/* isoprint-virtual at the far end of something. */
#ifndef FIO_CLI_VIRTUAL_SERVE_H
#define FIO_CLI_VIRTUAL_SERVE_H

#include "virtual_check.h"
#include "virtual_options.h"

/* *code: of the command that was run, 0 without one. */
fio_status virtual_serve(const virtual_arguments *given, const fio_execution_log *log,
                         virtual_check *check, int *code) FIO_MUST_CHECK;

#endif
