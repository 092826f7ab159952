/* The chips of the virtual printer, told what Linux' own drivers (6.1) were seen to tell devices of
 * their kind: opened at 115200, closed, opened again, changed to 250000. They must take it all, and
 * end with that rate, the lines up, and a printer that answers. */
#include "check.h"
#include "serial/link.h"

typedef struct step {
    uint8_t type, request;
    uint16_t value, index, length;
    uint8_t data[16];
} step;

static const step ch340[] = {
    {0xc0, 0x5f, 0, 0, 2, {0}},           {0x40, 0xa1, 0, 0, 0, {0}},
    {0x40, 0x9a, 0x1312, 0xb282, 0, {0}}, {0x40, 0x9a, 0x2518, 0x00c3, 0, {0}},
    {0x40, 0xa4, 0xffff, 0, 0, {0}},      {0xc0, 0x95, 0x0005, 0, 2, {0}},
    {0x40, 0x9a, 0x1312, 0xb282, 0, {0}}, {0x40, 0x9a, 0x2518, 0x00c3, 0, {0}},
    {0x40, 0xa4, 0xffff, 0, 0, {0}},      {0xc0, 0x95, 0x0706, 0, 2, {0}},
    {0x40, 0xa4, 0xff9f, 0, 0, {0}},      {0x40, 0x9a, 0x1312, 0xcc83, 0, {0}},
    {0x40, 0x9a, 0x2518, 0x00c3, 0, {0}}, {0x40, 0xa4, 0xff9f, 0, 0, {0}},
    {0x40, 0x9a, 0x1312, 0xcc83, 0, {0}}, {0x40, 0x9a, 0x2518, 0x00c3, 0, {0}},
    {0x40, 0xa4, 0xff9f, 0, 0, {0}},      {0xc0, 0x95, 0x0706, 0, 2, {0}},
    {0x40, 0xa4, 0xff9f, 0, 0, {0}},      {0x40, 0x9a, 0x1312, 0xe883, 0, {0}},
    {0x40, 0x9a, 0x2518, 0x00c3, 0, {0}}, {0x40, 0xa4, 0xff9f, 0, 0, {0}}};

static const step ftdi[] = {{0xc0, 0x0a, 0, 0, 1, {0}},
                            {0x40, 0x09, 0x0010, 0, 0, {0}},
                            {0xc0, 0x90, 0, 0x000a, 2, {0}},
                            {0x40, 0x00, 0, 0, 0, {0}},
                            {0x40, 0x04, 0x0008, 0, 0, {0}},
                            {0x40, 0x03, 0x4138, 0, 0, {0}},
                            {0x40, 0x02, 0x1311, 0x0400, 0, {0}},
                            {0x40, 0x01, 0x0303, 0, 0, {0}},
                            {0x40, 0x03, 0x001a, 0, 0, {0}},
                            {0x40, 0x02, 0, 0, 0, {0}},
                            {0xc0, 0x05, 0, 0, 2, {0}},
                            {0x40, 0x00, 0, 0, 0, {0}},
                            {0x40, 0x04, 0x0008, 0, 0, {0}},
                            {0x40, 0x03, 0x001a, 0, 0, {0}},
                            {0x40, 0x02, 0, 0, 0, {0}},
                            {0x40, 0x01, 0x0303, 0, 0, {0}},
                            {0x40, 0x03, 0x000c, 0, 0, {0}},
                            {0x40, 0x02, 0, 0, 0, {0}},
                            {0xc0, 0x05, 0, 0, 2, {0}}};

static const step cp2102[] = {{0xc0, 0xff, 0x370b, 0, 1, {0}},
                              {0x41, 0x00, 1, 0, 0, {0}},
                              {0x41, 0x1e, 0, 0, 4, {0x80, 0x25}},
                              {0x41, 0x03, 0x0800, 0, 0, {0}},
                              {0x41, 0x19, 0, 0, 6, {0, 0, 0, 0, 0x11, 0x13}},
                              {0xc1, 0x14, 0, 0, 16, {0}},
                              {0x41, 0x13, 0, 0, 16, {0, 0, 0, 0, 1}},
                              {0x41, 0x07, 0x0303, 0, 0, {0}},
                              {0x41, 0x1e, 0, 0, 4, {0x00, 0xc2, 0x01}},
                              {0x41, 0x03, 0x0800, 0, 0, {0}},
                              {0xc1, 0x14, 0, 0, 16, {0}},
                              {0x41, 0x13, 0, 0, 16, {1, 0, 0, 0, 0x40}},
                              {0xc1, 0x10, 0, 0, 19, {0}},
                              {0x41, 0x12, 0x000f, 0, 0, {0}},
                              {0x41, 0x00, 0, 0, 0, {0}},
                              {0x41, 0x00, 1, 0, 0, {0}},
                              {0x41, 0x1e, 0, 0, 4, {0x00, 0xc2, 0x01}},
                              {0x41, 0x03, 0x0800, 0, 0, {0}},
                              {0xc1, 0x14, 0, 0, 16, {0}},
                              {0x41, 0x13, 0, 0, 16, {1, 0, 0, 0, 0x40}},
                              {0x41, 0x07, 0x0303, 0, 0, {0}},
                              {0x41, 0x1e, 0, 0, 4, {0x90, 0xd0, 0x03}},
                              {0x41, 0x03, 0x0800, 0, 0, {0}}};

static const step pl2303hxn[] = {{0x40, 0x80, 0x0007, 0x0003, 0, {0}},
                                 {0xa1, 0x21, 0, 0, 7, {0}},
                                 {0x21, 0x20, 0, 0, 7, {0x80, 0x25, 0, 0, 0, 0, 8}},
                                 {0xc0, 0x81, 0x000a, 0, 1, {0}},
                                 {0x40, 0x80, 0x000a, 0x000c, 0, {0}},
                                 {0x21, 0x22, 3, 0, 0, {0}},
                                 {0xa1, 0x21, 0, 0, 7, {0}},
                                 {0x21, 0x20, 0, 0, 7, {0x00, 0xc2, 0x01, 0, 0, 0, 8}},
                                 {0xc0, 0x81, 0x000a, 0, 1, {0}},
                                 {0x40, 0x80, 0x000a, 0x001c, 0, {0}},
                                 {0x21, 0x23, 0, 0, 0, {0}},
                                 {0x40, 0x80, 0x0007, 0x0003, 0, {0}},
                                 {0xa1, 0x21, 0, 0, 7, {0}},
                                 {0x21, 0x20, 0, 0, 7, {0x00, 0xc2, 0x01, 0, 0, 0, 8}},
                                 {0xc0, 0x81, 0x000a, 0, 1, {0}},
                                 {0x40, 0x80, 0x000a, 0x001c, 0, {0}},
                                 {0x21, 0x22, 3, 0, 0, {0}},
                                 {0xa1, 0x21, 0, 0, 7, {0}},
                                 {0x21, 0x20, 0, 0, 7, {0x90, 0xd0, 0x03, 0, 0, 0, 8}},
                                 {0xc0, 0x81, 0x000a, 0, 1, {0}},
                                 {0x40, 0x80, 0x000a, 0x001c, 0, {0}},
                                 {0x21, 0x23, 0, 0, 0, {0}}};

static void play(const char *chip, const step *steps, size_t count) {
    usb_link *l = link_plug(chip, 250000, NULL);
    for (size_t i = 0; i < count; i++) {
        uint8_t data[32] = {0};
        memcpy(data, steps[i].data, sizeof steps[i].data);
        int moved = link_ask(l, steps[i].type, steps[i].request, steps[i].value, steps[i].index,
                             data, steps[i].length);
        if (!CHECK_EQUAL(steps[i].length, moved))
            fprintf(stderr, "  %s, request %zu\n", chip, i);
        l->now += 0.0005;
    }
    link_run(l, 0.2);
    CHECK(link_talk(l));
    CHECK(fio_machine_count(l->machine)->resets >= 1); /* DTR rose */
    link_unplug(l);
}

#define PLAY(chip, steps) play(chip, steps, sizeof(steps) / sizeof *(steps))

static void test_ch340(void) {
    PLAY("ch340", ch340);
}

/* The limited one refuses the break register, and Linux goes on without it. */
static void test_ch340_limited(void) {
    usb_link *l = link_plug("ch340-limited", 115200, NULL);
    uint8_t data[2];
    CHECK_EQUAL(FIO_USB_STALL, link_ask(l, 0xc0, 0x95, 0x0005, 0, data, 2));
    CHECK_EQUAL(2, link_ask(l, 0xc0, 0x95, 0x0706, 0, data, 2));
    CHECK_EQUAL(0xff, data[0]);
    CHECK_EQUAL(0xee, data[1]);
    link_unplug(l);
}

static void test_ftdi(void) {
    PLAY("ftdi", ftdi);
}

static void test_cp2102(void) {
    PLAY("cp2102", cp2102);
}

static void test_pl2303hxn(void) {
    PLAY("pl2303hxn", pl2303hxn);
}

int main(void) {
    RUN(test_ch340);
    RUN(test_ch340_limited);
    RUN(test_ftdi);
    RUN(test_cp2102);
    RUN(test_pl2303hxn);
    return check_verdict();
}
