/* What the chips of a virtual USB device share: their place in it, and the device around them. */
#ifndef FIO_VIRTUAL_CHIP_H
#define FIO_VIRTUAL_CHIP_H

#include "virtual/usb_device.h"

enum { FIO_CHIP_PACKET_MOST = 512, FIO_CHIP_DESCRIPTORS_MOST = 128 };

typedef struct fio_setup {
    uint8_t type, request;
    uint16_t value, index, length;
} fio_setup;

typedef struct fio_chip {
    const char *name, *maker, *model;
    uint16_t vendor, product, release, version;
    uint8_t control_packet;
    uint8_t interface[3]; /* class, subclass, protocol of the interface with the bulk endpoints */
    uint8_t in, out, interrupt; /* endpoint addresses; interrupt 0: it has none */
    uint16_t packet;            /* bytes, both ways */
    bool communication;         /* a CDC control interface comes first, with the interrupt */
    bool ends_transfers;        /* an empty packet follows a full one if there is no more */
    bool status_bytes;          /* FTDI: two in front of each packet, and empty ones every 16 ms */
    bool limited;
    bool ready; /* bytes flow from the start, not only once the host has set it up */

    /* A class or vendor request. `data`: `length` bytes from the host, or room for as many for the
     * answer. Returns the bytes moved, or FIO_USB_STALL for what the chip does not know. */
    int (*control)(fio_virtual_usb *device, double now, const fio_setup *setup, uint8_t *data);
} fio_chip;

extern const fio_chip fio_chip_cdc_acm, fio_chip_ch340, fio_chip_ch340_limited, fio_chip_ftdi,
    fio_chip_ftdi_h, fio_chip_cp2102, fio_chip_pl2303hx, fio_chip_pl2303hxn;

struct fio_virtual_usb {
    const fio_chip *chip;
    fio_machine *machine; /* the caller's */
    void (*trace)(void *context, const uint8_t setup[8], const uint8_t *data, int moved);
    void *trace_context;
    char serial[64];
    uint8_t descriptors[FIO_CHIP_DESCRIPTORS_MOST];
    int descriptor_size;
    uint8_t configuration;
    bool in_halted, out_halted;
    bool gone; /* pulled out */

    /* The chips' own. */
    uint8_t registers[256];
    bool ready; /* bytes flow */
    bool dtr, rts;

    /* One packet that waits for room in the machine, and one that fills up for the host. */
    uint8_t outgoing[FIO_CHIP_PACKET_MOST], incoming[FIO_CHIP_PACKET_MOST];
    int outgoing_size, incoming_size;
    bool last_was_full;
    double latency, status_due; /* s */
    int event;                  /* a byte behind which it does not wait; -1 */
    bool refused;               /* a status packet was asked for and not due yet */
};

/* Copy an answer, cut at what the host asked for. Returns its length. */
int fio_chip_answer(const fio_setup *setup, uint8_t *data, const uint8_t *bytes, int size);

/* The rate the chip's registers make, and whether a byte has 8 bits and no parity: without, nothing
 * of it is understood at the other end. */
void fio_chip_set_rate(fio_virtual_usb *device, double now, double rate, bool eight_bits);

void fio_chip_set_lines(fio_virtual_usb *device, double now, bool dtr, bool rts);

/* The line coding of CDC, in registers[0 … 6]: what CDC and PL2303 have in common. */
int fio_chip_line_coding(fio_virtual_usb *device, const fio_setup *setup, uint8_t *data);

#endif
