#include "serial/devices.h"

#include <stdlib.h>

#include "check.h"

static fio_status request(void *context, uint8_t type, uint8_t code, uint16_t value, uint16_t index,
                          void *data, uint16_t length, uint16_t *moved, bool *stalled) {
    recorder *device = context;
    if (device->count == device->fail_at)
        return fio_fail(FIO_LINK_LOST, "pulled out");
    if (device->count < SEEN_MOST) {
        seen_request *seen = &device->seen[device->count];
        *seen = (seen_request){type, code, value, index, length, {0}};
        if (!(type & 0x80) && length > 0)
            memcpy(seen->data, data, length < 20 ? length : 20);
    }
    device->count++;
    *stalled = false;
    *moved = length;
    if (type & 0x80)
        memset(data, 0, length);
    for (int i = 0; i < device->answer_count; i++) {
        const answer *a = &device->answers[i];
        if (a->type != type || a->request != code || a->value != value)
            continue;
        *stalled = a->stall;
        *moved = a->stall ? 0 : (uint16_t)(a->length < length ? a->length : length);
        if (type & 0x80)
            memcpy(data, a->data, *moved);
        break;
    }
    return FIO_OK;
}

fio_control recorder_control(recorder *device) {
    return (fio_control){request, device};
}

void check_seen(recorder *device, const seen_request *expected, int count, const char *file,
                int line) {
    check_equal(count, device->count, "number of requests", file, line);
    for (int i = 0; i < count && i < device->count; i++) {
        const seen_request *e = &expected[i], *s = &device->seen[i];
        check_count++;
        if (e->type == s->type && e->request == s->request && e->value == s->value &&
            e->index == s->index && e->length == s->length &&
            memcmp(e->data, s->data, sizeof e->data) == 0)
            continue;
        check_failures++;
        fprintf(stderr,
                "%s:%d: request %d is %02x %02x %04x %04x length %d, not %02x %02x %04x %04x "
                "length %d (or its data differ)\n",
                file, line, i, s->type, s->request, s->value, s->index, s->length, e->type,
                e->request, e->value, e->index, e->length);
    }
    device->count = 0;
}

void raw_bytes(raw *to, const uint8_t *bytes, size_t size) {
    if (to->size + size > sizeof to->bytes)
        abort();
    memcpy(to->bytes + to->size, bytes, size);
    to->size += size;
}

raw raw_begin(raw_device d) {
    raw made = {.size = 0};
    const uint8_t device[18] = {18,
                                1,
                                (uint8_t)d.version,
                                (uint8_t)(d.version >> 8),
                                d.class_code,
                                0,
                                0,
                                d.control_packet,
                                (uint8_t)d.vendor,
                                (uint8_t)(d.vendor >> 8),
                                (uint8_t)d.product,
                                (uint8_t)(d.product >> 8),
                                (uint8_t)d.release,
                                (uint8_t)(d.release >> 8),
                                1,
                                2,
                                3,
                                1};
    const uint8_t configuration[9] = {9, 2, 0, 0, 1, 1, 0, 0x80, 50};
    raw_bytes(&made, device, sizeof device);
    raw_bytes(&made, configuration, sizeof configuration);
    return made;
}

void raw_interface(raw *to, uint8_t number, uint8_t alternate, const uint8_t class_code[3]) {
    const uint8_t bytes[9] = {
        9, 4, number, alternate, 0, class_code[0], class_code[1], class_code[2], 0};
    raw_bytes(to, bytes, sizeof bytes);
}

void raw_endpoint(raw *to, uint8_t address, uint8_t kind, uint16_t packet) {
    const uint8_t bytes[7] = {7, 5, address, kind, (uint8_t)packet, (uint8_t)(packet >> 8), 1};
    raw_bytes(to, bytes, sizeof bytes);
}

void raw_end(raw *to) {
    size_t total = to->size - 18;
    to->bytes[20] = (uint8_t)total;
    to->bytes[21] = (uint8_t)(total >> 8);
}

raw raw_mega(void) {
    raw made = raw_begin((raw_device){0x0110, 0x2341, 0x0042, 0x0001, 2, 8});
    raw_interface(&made, 0, 0, (const uint8_t[]){2, 2, 1});
    raw_bytes(&made, (const uint8_t[]){5, 0x24, 0, 0x10, 0x01}, 5);
    raw_bytes(&made, (const uint8_t[]){4, 0x24, 2, 6}, 4);
    raw_bytes(&made, (const uint8_t[]){5, 0x24, 6, 0, 1}, 5);
    raw_endpoint(&made, 0x82, 3, 8);
    raw_interface(&made, 1, 0, (const uint8_t[]){10, 0, 0});
    raw_endpoint(&made, 0x04, 2, 64);
    raw_endpoint(&made, 0x83, 2, 64);
    raw_end(&made);
    return made;
}

raw raw_bridge(raw_device device, uint16_t packet) {
    raw made = raw_begin(device);
    raw_interface(&made, 0, 0, (const uint8_t[]){0xff, 0, 0});
    raw_endpoint(&made, 0x81, 3, 10);
    raw_endpoint(&made, 0x02, 2, packet);
    raw_endpoint(&made, 0x83, 2, packet);
    raw_end(&made);
    return made;
}
