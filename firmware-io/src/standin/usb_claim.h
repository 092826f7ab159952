/* Who has the interfaces of a device: nobody, one of Linux' own drivers, or a program through
 * usbfs. Errors are errno values, 0 for none, as the kernel gives them. */
#ifndef FIO_STANDIN_USB_CLAIM_H
#define FIO_STANDIN_USB_CLAIM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { FIO_USB_CLAIMS = 8 };

typedef struct fio_usb_claims {
    int count, first_bound;
    bool acm; /* cdc-acm has the first two together, or neither of them */
    bool bound[FIO_USB_CLAIMS];
    const void *client[FIO_USB_CLAIMS];
} fio_usb_claims;

/* `bound`: the kernel's driver has all of them at first. */
void fio_usb_claims_begin(fio_usb_claims *claims, const uint8_t *descriptors, size_t size,
                          bool bound);

/* "usbfs", the kernel driver's name, NULL: nobody has it. */
const char *fio_usb_claims_driver(const fio_usb_claims *claims, unsigned interface);
bool fio_usb_claims_user(const fio_usb_claims *claims, unsigned interface);

int fio_usb_claims_claim(fio_usb_claims *claims, unsigned interface, const void *client);
int fio_usb_claims_release(fio_usb_claims *claims, unsigned interface, const void *client);

/* Take it from the kernel's driver, or let that look at it again. */
int fio_usb_claims_unbind(fio_usb_claims *claims, unsigned interface);
int fio_usb_claims_bind(fio_usb_claims *claims, unsigned interface);

void fio_usb_claims_vanish(fio_usb_claims *claims, const void *client);
void fio_usb_claims_count(const fio_usb_claims *claims, int *now, int *first);

#endif
