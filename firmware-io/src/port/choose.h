/* Which of the ports there are is meant. */
#ifndef FIO_PORT_CHOOSE_H
#define FIO_PORT_CHOOSE_H

#include "port/list.h"

/* For "auto": the only certain one, or else the only one. FIO_NO_PRINTER with a message that says
 * which ones there are. */
fio_status fio_port_choose(const fio_port_entry **chosen,
                           const fio_port_table *table) FIO_MUST_CHECK;

/* For "usb:…", well-formed: the only device of that name. FIO_NO_PRINTER with a message. */
fio_status fio_port_choose_usb(const fio_usb_found **chosen, const fio_port_table *table,
                               const char *name) FIO_MUST_CHECK;

#endif
