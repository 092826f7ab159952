/* Why a USB device could not be opened, and what its user can do about it. */
#ifndef FIO_USB_TROUBLE_H
#define FIO_USB_TROUBLE_H

#include <stddef.h>

#include <isoprint/status.h>

#include "usb/device.h"

/* The system does not let us: whose the device is, whether the udev rules are there. */
void fio_usb_explain_access(char *text, size_t capacity, const fio_usb_found *found);

/* Another program has it; `holder` is who, NULL if that is not known. */
void fio_usb_explain_busy(char *text, size_t capacity, const fio_usb_found *found,
                          const char *holder);

#endif
