/* --list: the ports that a printer may be behind. */
#ifndef FIO_CLI_LIST_H
#define FIO_CLI_LIST_H

#include "connection.h"

fio_status fio_list_print(const fio_arguments *arguments, fio_control *control) FIO_MUST_CHECK;

#endif
