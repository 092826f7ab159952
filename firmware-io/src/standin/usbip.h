/* The virtual printer as a device of USB/IP: a server that `usbip attach` imports it from, or the
 * far end of a socket that is handed to Linux' own vhci_hcd. Protocol: the kernel's
 * Documentation/usb/usbip_protocol.rst. */
#ifndef FIO_STANDIN_USBIP_H
#define FIO_STANDIN_USBIP_H

#include "standin/standin.h"
#include "virtual/usb_device.h"

enum { FIO_USBIP_PORT = 3240 };

/* Serve on a TCP port of `host`; 0: any free one. The device stays the caller's. */
fio_status fio_standin_usbip(fio_standin **standin, fio_machine *machine, fio_pace *pace,
                             fio_virtual_usb *device, const char *host, int port) FIO_MUST_CHECK;

/* The far end of a socket over which a kernel, or a test, sends its URBs at once. The descriptor is
 * non-blocking and belongs to the stand-in from now on, also on failure. */
fio_status fio_standin_usbip_socket(fio_standin **standin, fio_machine *machine, fio_pace *pace,
                                    fio_virtual_usb *device, int file) FIO_MUST_CHECK;

/* Plug it into this machine's own kernel: needs root and the module vhci_hcd. */
fio_status fio_standin_vhci(fio_standin **standin, fio_machine *machine, fio_pace *pace,
                            fio_virtual_usb *device) FIO_MUST_CHECK;

#endif
