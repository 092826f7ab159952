/* Descriptors as devices have them, and a device at the far end of the control requests that keeps
 * what it is told. */
#ifndef TESTS_SERIAL_DEVICES_H
#define TESTS_SERIAL_DEVICES_H

#include "serial/serial.h"

/* One request as seen on the bus: set-up, and the data of one that goes to the device. */
typedef struct seen_request {
    uint8_t type, request;
    uint16_t value, index, length;
    uint8_t data[20];
} seen_request;

typedef struct answer {
    uint8_t type, request;
    uint16_t value;
    bool stall;
    int length;
    uint8_t data[20];
} answer;

enum { SEEN_MOST = 64 };

typedef struct recorder {
    const answer *answers; /* of what is not listed here, reads are zeros and writes are taken */
    int answer_count;
    int fail_at; /* that request fails altogether; -1 */
    int count;
    seen_request seen[SEEN_MOST];
} recorder;

fio_control recorder_control(recorder *device);

/* Check that exactly these requests were seen, and forget them. */
void check_seen(recorder *device, const seen_request *expected, int count, const char *file,
                int line);

#define CHECK_SEEN(device, expected)                                                               \
    check_seen(device, expected, (int)(sizeof(expected) / sizeof *(expected)), __FILE__, __LINE__)

/* Builders of descriptors. */
typedef struct raw {
    uint8_t bytes[512];
    size_t size;
} raw;

typedef struct raw_device {
    uint16_t version, vendor, product, release;
    uint8_t class_code, control_packet;
} raw_device;

raw raw_begin(raw_device device);
void raw_interface(raw *to, uint8_t number, uint8_t alternate, const uint8_t class_code[3]);
void raw_endpoint(raw *to, uint8_t address, uint8_t kind, uint16_t packet);
void raw_bytes(raw *to, const uint8_t *bytes, size_t size);
void raw_end(raw *to); /* writes the configuration's total length */

raw raw_mega(void); /* an Arduino Mega 2560: CDC with a Union descriptor */
raw raw_bridge(raw_device device, uint16_t packet); /* one vendor interface, two bulk endpoints */

#endif
