#include "standin/usb_claim.h"

#include <errno.h>

void fio_usb_claims_begin(fio_usb_claims *claims, const uint8_t *descriptors, size_t size,
                          bool bound) {
    *claims = (fio_usb_claims){0};
    for (size_t at = 0; at + 9 <= size && descriptors[at] >= 2; at += descriptors[at])
        if (descriptors[at + 1] == 4 && descriptors[at + 3] == 0 &&
            claims->count < FIO_USB_CLAIMS) {
            claims->acm |= descriptors[at + 5] == 2 && claims->count == 0;
            claims->bound[claims->count++] = bound;
        }
    claims->acm &= claims->count >= 2;
    claims->first_bound = bound ? claims->count : 0;
}

const char *fio_usb_claims_driver(const fio_usb_claims *claims, unsigned interface) {
    if (interface >= (unsigned)claims->count)
        return NULL;
    if (claims->client[interface])
        return "usbfs";
    if (!claims->bound[interface])
        return NULL;
    return claims->acm ? "cdc_acm" : "usbserial_generic";
}

bool fio_usb_claims_user(const fio_usb_claims *claims, unsigned interface) {
    return interface < (unsigned)claims->count && claims->client[interface];
}

int fio_usb_claims_claim(fio_usb_claims *claims, unsigned interface, const void *client) {
    if (interface >= (unsigned)claims->count)
        return ENOENT;
    if (claims->bound[interface] ||
        (claims->client[interface] && claims->client[interface] != client))
        return EBUSY;
    claims->client[interface] = client;
    return 0;
}

int fio_usb_claims_release(fio_usb_claims *claims, unsigned interface, const void *client) {
    if (interface >= (unsigned)claims->count || claims->client[interface] != client)
        return EINVAL;
    claims->client[interface] = NULL;
    return 0;
}

int fio_usb_claims_unbind(fio_usb_claims *claims, unsigned interface) {
    if (interface >= (unsigned)claims->count || !claims->bound[interface])
        return ENODATA;
    claims->bound[interface] = false;
    if (claims->acm && interface < 2) /* acm_disconnect() lets go of its other interface too */
        claims->bound[0] = claims->bound[1] = false;
    return 0;
}

/* cdc-acm takes both interfaces when it is shown the control interface, and gives up if somebody
 * else has the data interface then; shown that one alone it does nothing. */
int fio_usb_claims_bind(fio_usb_claims *claims, unsigned interface) {
    if (interface >= (unsigned)claims->count)
        return EINVAL;
    if (claims->client[interface] || claims->bound[interface])
        return EBUSY;
    if (!claims->acm || interface > 1)
        claims->bound[interface] = claims->first_bound > 0;
    else if (interface == 0 && !claims->client[1])
        claims->bound[0] = claims->bound[1] = claims->first_bound > 0;
    return 0;
}

void fio_usb_claims_vanish(fio_usb_claims *claims, const void *client) {
    for (int i = 0; i < claims->count; i++)
        if (claims->client[i] == client)
            claims->client[i] = NULL;
}

void fio_usb_claims_count(const fio_usb_claims *claims, int *now, int *first) {
    *first = claims->first_bound;
    *now = 0;
    for (int i = 0; i < claims->count; i++)
        *now += claims->bound[i];
}
