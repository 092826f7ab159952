#include "virtual/chip.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"

enum {
    GET_STATUS = 0,
    CLEAR_FEATURE = 1,
    SET_FEATURE = 3,
    SET_ADDRESS = 5,
    GET_DESCRIPTOR = 6,
    GET_CONFIGURATION = 8,
    SET_CONFIGURATION = 9,
    GET_INTERFACE = 10,
    SET_INTERFACE = 11,
    DEVICE = 1, /* descriptors */
    CONFIGURATION = 2,
    STRING = 3,
    QUALIFIER = 6,
    DEVICE_SIZE = 18,
    BULK = 2,
    INTERRUPT = 3,
    STATUS_BYTES = 2
};

static const fio_chip *const chips[] = {
    &fio_chip_cdc_acm, &fio_chip_ch340,  &fio_chip_ch340_limited, &fio_chip_ftdi,
    &fio_chip_ftdi_h,  &fio_chip_cp2102, &fio_chip_pl2303hx,      &fio_chip_pl2303hxn};

static void add(fio_virtual_usb *device, const uint8_t *bytes, int size) {
    memcpy(device->descriptors + device->descriptor_size, bytes, (size_t)size);
    device->descriptor_size += size;
}

static void add_interface(fio_virtual_usb *device, int number, int endpoints,
                          const uint8_t class_code[3]) {
    add(device,
        (const uint8_t[]){9, 4, (uint8_t)number, 0, (uint8_t)endpoints, class_code[0],
                          class_code[1], class_code[2], 0},
        9);
}

static void add_endpoint(fio_virtual_usb *device, uint8_t address, uint8_t kind, uint16_t packet) {
    add(device,
        (const uint8_t[]){7, 5, address, kind, (uint8_t)packet, (uint8_t)(packet >> 8),
                          kind == INTERRUPT ? 16 : 0},
        7);
}

static void add_communication(fio_virtual_usb *device, bool no_union) {
    add_interface(device, 0, 1, (const uint8_t[]){2, 2, 1});
    add(device, (const uint8_t[]){5, 0x24, 0, 0x10, 0x01}, 5); /* CDC 1.10 */
    add(device, (const uint8_t[]){5, 0x24, 1, 0, 1}, 5);       /* no call management */
    add(device, (const uint8_t[]){4, 0x24, 2, 6}, 4);          /* line coding, and breaks */
    if (!no_union)
        add(device, (const uint8_t[]){5, 0x24, 6, 0, 1}, 5);
    add_endpoint(device, device->chip->interrupt, INTERRUPT, 8);
}

static void describe(fio_virtual_usb *device, const fio_virtual_usb_options *options) {
    const fio_chip *chip = device->chip;
    uint16_t vendor = options->vendor ? options->vendor : chip->vendor,
             product = options->product ? options->product : chip->product;
    const uint8_t about[DEVICE_SIZE] = {DEVICE_SIZE,
                                        DEVICE,
                                        (uint8_t)chip->version,
                                        (uint8_t)(chip->version >> 8),
                                        chip->communication ? 2 : 0,
                                        0,
                                        0,
                                        chip->control_packet,
                                        (uint8_t)vendor,
                                        (uint8_t)(vendor >> 8),
                                        (uint8_t)product,
                                        (uint8_t)(product >> 8),
                                        (uint8_t)chip->release,
                                        (uint8_t)(chip->release >> 8),
                                        1,
                                        2,
                                        3,
                                        1};
    int interfaces = chip->communication ? 2 : 1;
    add(device, about, sizeof about);
    add(device, (const uint8_t[]){9, CONFIGURATION, 0, 0, (uint8_t)interfaces, 1, 0, 0x80, 50}, 9);
    if (chip->communication)
        add_communication(device, options->no_union);
    bool interrupt = chip->interrupt != 0 && !chip->communication;
    add_interface(device, interfaces - 1, interrupt ? 3 : 2, chip->interface);
    if (interrupt)
        add_endpoint(device, chip->interrupt, INTERRUPT, 10);
    add_endpoint(device, chip->out, BULK, chip->packet);
    add_endpoint(device, chip->in, BULK, chip->packet);
    int total = device->descriptor_size - DEVICE_SIZE;
    device->descriptors[DEVICE_SIZE + 2] = (uint8_t)total;
    device->descriptors[DEVICE_SIZE + 3] = (uint8_t)(total >> 8);
}

/* As it is when it gets its power. */
static void power_up(fio_virtual_usb *device) {
    memset(device->registers, 0, sizeof device->registers);
    device->ready = device->chip->ready;
    device->dtr = device->rts = false;
    device->configuration = 0;
    device->in_halted = device->out_halted = device->last_was_full = device->refused = false;
    device->outgoing_size = device->incoming_size = 0;
    device->latency = 0.016;
    device->event = -1;
}

fio_status fio_virtual_usb_create(fio_virtual_usb **made, fio_machine *machine,
                                  const fio_virtual_usb_options *options) {
    *made = NULL;
    const fio_chip *chip = NULL;
    for (size_t i = 0; i < sizeof chips / sizeof *chips && !chip; i++)
        if (options->chip && strcmp(options->chip, chips[i]->name) == 0)
            chip = chips[i];
    if (!chip)
        return fio_fail(FIO_USAGE,
                        "no such chip: %s; there are cdc-acm, ch340, ch340-limited, ftdi, ftdi-h, "
                        "cp2102, pl2303hx and pl2303hxn",
                        options->chip ? options->chip : "(none)");
    const char *serial = options->serial ? options->serial : "VP0001";
    if (strlen(serial) >= sizeof(((fio_virtual_usb *)0)->serial))
        return fio_fail(FIO_USAGE, "a serial number of more than 63 characters: %s", serial);
    fio_virtual_usb *device = fio_allocate(sizeof *device);
    if (!device)
        return fio_fail(FIO_NO_MEMORY, "no memory for a virtual USB device");
    *device = (fio_virtual_usb){.chip = chip,
                                .machine = machine,
                                .trace = options->trace,
                                .trace_context = options->trace_context};
    power_up(device);
    snprintf(device->serial, sizeof device->serial, "%s", serial);
    describe(device, options);
    *made = device;
    return FIO_OK;
}

void fio_virtual_usb_free(fio_virtual_usb *device) {
    fio_release(device);
}

const uint8_t *fio_virtual_usb_descriptors(const fio_virtual_usb *device, size_t *size) {
    *size = (size_t)device->descriptor_size;
    return device->descriptors;
}

bool fio_virtual_usb_high_speed(const fio_virtual_usb *device) {
    return device->chip->packet > 64;
}

const char *fio_virtual_usb_string(const fio_virtual_usb *device, int index) {
    switch (index) {
    case 1:
        return device->chip->maker;
    case 2:
        return device->chip->model;
    case 3:
        return device->serial;
    default:
        return NULL;
    }
}

int fio_chip_answer(const fio_setup *setup, uint8_t *data, const uint8_t *bytes, int size) {
    int moved = size < setup->length ? size : setup->length;
    memcpy(data, bytes, (size_t)moved);
    return moved;
}

void fio_chip_set_rate(fio_virtual_usb *device, double now, double rate, bool eight_bits) {
    /* Half the rate stands for frames that the other end can't make sense of. */
    fio_machine_set_rate(device->machine, now, llround(fmax(eight_bits ? rate : rate / 2, 1)));
}

void fio_chip_set_lines(fio_virtual_usb *device, double now, bool dtr, bool rts) {
    device->dtr = dtr;
    device->rts = rts;
    fio_machine_set_lines(device->machine, now, dtr, rts);
}

int fio_chip_line_coding(fio_virtual_usb *device, const fio_setup *setup, uint8_t *data) {
    if (setup->type == 0xa1 && setup->request == 0x21)
        return fio_chip_answer(setup, data, device->registers, 7);
    if (setup->type != 0x21 || setup->request != 0x20 || setup->length != 7)
        return FIO_USB_STALL;
    memcpy(device->registers, data, 7);
    return 7;
}

static int string_descriptor(const fio_virtual_usb *device, const fio_setup *setup, uint8_t *data) {
    uint8_t bytes[2 + 2 * 64] = {4, STRING, 0x09, 0x04}; /* US English */
    int index = setup->value & 255, size = 4;
    if (index > 0) {
        const char *text = fio_virtual_usb_string(device, index);
        if (!text)
            return FIO_USB_STALL;
        size = 2;
        for (; *text && size < (int)sizeof bytes - 1; text++, size += 2) {
            bytes[size] = (uint8_t)*text;
            bytes[size + 1] = 0;
        }
        bytes[0] = (uint8_t)size;
    }
    return fio_chip_answer(setup, data, bytes, size);
}

static int get_descriptor(const fio_virtual_usb *device, const fio_setup *setup, uint8_t *data) {
    const uint8_t *about = device->descriptors;
    switch (setup->value >> 8) {
    case DEVICE:
        return fio_chip_answer(setup, data, about, DEVICE_SIZE);
    case CONFIGURATION:
        if (setup->value & 255)
            return FIO_USB_STALL;
        return fio_chip_answer(setup, data, about + DEVICE_SIZE,
                               device->descriptor_size - DEVICE_SIZE);
    case STRING:
        return string_descriptor(device, setup, data);
    case QUALIFIER: /* of the other speed: only a device that has two of them answers */
        if (!fio_virtual_usb_high_speed(device))
            return FIO_USB_STALL;
        return fio_chip_answer(setup, data,
                               (const uint8_t[]){10, QUALIFIER, about[2], about[3], about[4],
                                                 about[5], about[6], about[7], 1, 0},
                               10);
    default:
        return FIO_USB_STALL;
    }
}

static int endpoint_feature(fio_virtual_usb *device, const fio_setup *setup) {
    bool halt = setup->request == SET_FEATURE;
    if (setup->value != 0)
        return FIO_USB_STALL;
    if (setup->index == device->chip->in)
        device->in_halted = halt;
    else if (setup->index == device->chip->out)
        device->out_halted = halt;
    return 0;
}

static int standard_request(fio_virtual_usb *device, const fio_setup *setup, uint8_t *data) {
    const uint8_t zeros[2] = {0, 0};
    switch (setup->request) {
    case GET_STATUS: {
        bool halted = (setup->index == device->chip->in && device->in_halted) ||
                      (setup->index == device->chip->out && device->out_halted);
        return fio_chip_answer(setup, data,
                               (const uint8_t[]){setup->type == 0x82 && halted ? 1 : 0, 0}, 2);
    }
    case CLEAR_FEATURE:
    case SET_FEATURE:
        return setup->type == 0x02 ? endpoint_feature(device, setup) : 0;
    case SET_ADDRESS:
    case SET_INTERFACE:
        return setup->request == SET_INTERFACE && setup->value != 0 ? FIO_USB_STALL : 0;
    case GET_DESCRIPTOR:
        return get_descriptor(device, setup, data);
    case GET_CONFIGURATION:
        return fio_chip_answer(setup, data, &device->configuration, 1);
    case SET_CONFIGURATION:
        if (setup->value > 1)
            return FIO_USB_STALL;
        device->configuration = (uint8_t)setup->value;
        device->in_halted = device->out_halted = false;
        return 0;
    case GET_INTERFACE:
        return fio_chip_answer(setup, data, zeros, 1);
    default:
        return FIO_USB_STALL;
    }
}

/* The chip lives on the bus's power: plugged in again, it has forgotten all. */
static bool present(fio_virtual_usb *device, double now) {
    fio_machine_advance(device->machine, now);
    bool plugged = fio_machine_plugged(device->machine);
    if (plugged && device->gone) {
        power_up(device);
        fio_machine_set_lines(device->machine, now, false, false);
    }
    device->gone = !plugged;
    return plugged;
}

int fio_virtual_usb_control(fio_virtual_usb *device, double now, const uint8_t bytes[8],
                            uint8_t *data, int capacity) {
    if (!present(device, now))
        return FIO_USB_GONE;
    fio_setup setup = {bytes[0], bytes[1], (uint16_t)(bytes[2] | bytes[3] << 8),
                       (uint16_t)(bytes[4] | bytes[5] << 8), (uint16_t)(bytes[6] | bytes[7] << 8)};
    int moved = FIO_USB_STALL;
    if ((setup.type & 0x80) && setup.length > capacity)
        setup.length = (uint16_t)(capacity > 0 ? capacity : 0);
    if (setup.length <= capacity || setup.length == 0)
        moved = (setup.type & 0x60) == 0 ? standard_request(device, &setup, data)
                                         : device->chip->control(device, now, &setup, data);
    if (device->trace)
        device->trace(device->trace_context, bytes, data, moved);
    return moved;
}

/* What is left of the last packet goes on its way as soon as there is room. */
static void push(fio_virtual_usb *device, double now) {
    if (device->outgoing_size == 0 || !device->ready)
        return;
    size_t taken =
        fio_machine_write(device->machine, now, device->outgoing, (size_t)device->outgoing_size);
    device->outgoing_size -= (int)taken;
    memmove(device->outgoing, device->outgoing + taken, (size_t)device->outgoing_size);
}

int fio_virtual_usb_out(fio_virtual_usb *device, double now, uint8_t endpoint, const uint8_t *bytes,
                        int size) {
    if (!present(device, now))
        return FIO_USB_GONE;
    if (endpoint != device->chip->out || device->out_halted || size > device->chip->packet)
        return FIO_USB_STALL;
    push(device, now);
    if (device->outgoing_size > 0)
        return FIO_USB_NAK;
    memcpy(device->outgoing, bytes, (size_t)size);
    device->outgoing_size = size;
    push(device, now);
    return size;
}

/* Fill the packet with what has arrived; it is lost while the receiver is off. */
static void pull(fio_virtual_usb *device, double now) {
    uint8_t lost[64];
    while (!device->ready && fio_machine_read(device->machine, now, lost, sizeof lost) > 0)
        continue;
    int room = device->chip->packet - (device->chip->status_bytes ? STATUS_BYTES : 0) -
               device->incoming_size;
    if (room > 0 && device->ready)
        device->incoming_size += (int)fio_machine_read(
            device->machine, now, device->incoming + device->incoming_size, (size_t)room);
}

/* A full packet at once, one with the byte to tell as well; what there is when the latency timer
 * ends, be it nothing. */
static int status_packet(fio_virtual_usb *device, double now, uint8_t *bytes) {
    bool full = device->incoming_size == device->chip->packet - STATUS_BYTES ||
                (device->event >= 0 &&
                 memchr(device->incoming, device->event, (size_t)device->incoming_size));
    device->refused = !full && now < device->status_due;
    if (device->refused)
        return FIO_USB_NAK;
    int size = device->incoming_size;
    bytes[0] = 0x01;
    bytes[1] = 0x60;
    memcpy(bytes + STATUS_BYTES, device->incoming, (size_t)size);
    device->incoming_size = 0;
    device->status_due = now + device->latency;
    return size + STATUS_BYTES;
}

int fio_virtual_usb_in(fio_virtual_usb *device, double now, uint8_t endpoint, uint8_t *bytes,
                       int capacity) {
    if (!present(device, now))
        return FIO_USB_GONE;
    if (device->chip->interrupt && endpoint == device->chip->interrupt)
        return FIO_USB_NAK;
    if (endpoint != device->chip->in || device->in_halted || capacity < device->chip->packet)
        return FIO_USB_STALL;
    push(device, now);
    pull(device, now);
    if (device->chip->status_bytes)
        return status_packet(device, now, bytes);
    int size = device->incoming_size;
    if (size == 0 && !device->last_was_full)
        return FIO_USB_NAK;
    memcpy(bytes, device->incoming, (size_t)size);
    device->incoming_size = 0;
    device->last_was_full = size == device->chip->packet && device->chip->ends_transfers;
    return size;
}

double fio_virtual_usb_next(const fio_virtual_usb *device) {
    /* What a chip that is not set up yet receives is not to be had. */
    bool useless = !device->ready && fio_machine_readable(device->machine);
    double next = useless ? INFINITY : fio_machine_next(device->machine);
    return device->refused ? fmin(next, device->status_due) : next;
}
