/* libusb as far as our transfers use it, played by the test: transfers stay where they were
 * submitted until the test ends them. */
#ifndef TESTS_TRANSPORT_FAKE_LIBUSB_H
#define TESTS_TRANSPORT_FAKE_LIBUSB_H

#include <libusb.h>
#include <stdbool.h>

enum { FAKE_FLYING = 32 };

typedef struct fake_libusb {
    struct libusb_transfer *flying[FAKE_FLYING]; /* in the order of submission */
    bool cancelled[FAKE_FLYING];
    int count;
    int submitted, halts_cleared;
    unsigned char halt_cleared; /* the endpoint of the last one */
    int refuse;                 /* an error of submit() from now on, 0 */
    bool deaf;                  /* cancelled transfers never end */
} fake_libusb;

extern fake_libusb fake;

void fake_begin(void);

/* End the n-th transfer under way on an endpoint, `size` bytes of it moved; of IN transfers they
 * are taken from `bytes`, NULL: zeros. False if there is no such transfer. */
bool fake_end(unsigned char endpoint, int n, enum libusb_transfer_status status, int size,
              const void *bytes);

/* The n-th transfer under way on an endpoint; NULL. */
struct libusb_transfer *fake_flying(unsigned char endpoint, int n);
int fake_count(unsigned char endpoint);

#endif
