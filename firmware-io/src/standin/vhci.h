/* Linux' virtual host controller. */
#ifndef FIO_STANDIN_VHCI_H
#define FIO_STANDIN_VHCI_H

#include <isoprint/status.h>

/* Plug a device into a free port of vhci_hcd: *file is our end of the socket that its URBs come
 * over; closing it unplugs. `speed` as fio_usbip_speed(); `device`: bus << 16 | number. */
fio_status fio_vhci_attach(int *file, int speed, int device) FIO_MUST_CHECK;

#endif
