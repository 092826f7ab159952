/* What the drivers share: requests that must succeed, the search for endpoints, the rate's limits.
 */
#ifndef FIO_SERIAL_DRIVER_H
#define FIO_SERIAL_DRIVER_H

#include "serial/serial.h"

extern const fio_serial_driver fio_serial_cdc_acm, fio_serial_ch34x, fio_serial_ftdi,
    fio_serial_cp210x, fio_serial_pl2303;

typedef struct fio_usb_id {
    uint16_t vendor, product;
} fio_usb_id;

bool fio_usb_id_among(const fio_usb_device *device, const fio_usb_id *ids, size_t count);

/* The first pair of bulk endpoints of an interface into `serial`, with the packet sizes. */
bool fio_serial_take_endpoints(fio_serial *serial, const fio_usb_interface *interface);

/* Of a vendor's chip: the first interface in its basic setting that has a pair of them. */
bool fio_serial_take_interface(fio_serial *serial, const fio_usb_device *device);

/* A control transfer's set-up. */
typedef struct fio_request {
    uint8_t type, request;
    uint16_t value, index, length;
} fio_request;

/* A request that the device must accept, with its data, NULL if there are none: FIO_NO_PRINTER if
 * it does not. */
fio_status fio_serial_send(const fio_serial *serial, fio_request request,
                           const void *data) FIO_MUST_CHECK;

/* Read into `data`. *answered false, and that is no failure, if the device stalls or answers with
 * fewer bytes. */
fio_status fio_serial_ask(const fio_serial *serial, fio_request request, void *data,
                          bool *answered) FIO_MUST_CHECK;

/* What set_lines() of a driver came to: if it succeeded, `serial` knows of it. */
fio_status fio_serial_note_lines(fio_serial *serial, bool dtr, bool rts,
                                 fio_status status) FIO_MUST_CHECK;

/* close() of a bridge of which nothing else has to be undone. With DTR up, many boards go on
 * sending and fill up once nobody reads. */
fio_status fio_serial_lower_lines(fio_serial *serial) FIO_MUST_CHECK;

/* FIO_USAGE if `nearest`, the rate the chip would really run at, is too far from `rate`. */
fio_status fio_serial_check_rate(const fio_serial *serial, int64_t rate,
                                 double nearest) FIO_MUST_CHECK;

#endif
