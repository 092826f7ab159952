/* The udev rules know each board that we know, and no others; read as udev reads them: one rule a
 * line, comments on lines of their own. */
#include "check.h"

#include "serial/serial.h"

#include <stdbool.h>
#include <stdlib.h>

enum { RULES_MOST = 200 };

static struct { unsigned vendor, product; } rules[RULES_MOST];
static int rule_count;

static void read_rules(const char *path) {
    char line[512];
    FILE *file = fopen(path, "r");
    if (!CHECK(file != NULL))
        return;
    bool began = false, ended = false, granted = false;
    while (fgets(line, sizeof line, file)) {
        unsigned vendor, product;
        if (line[0] == '#')
            continue;
        CHECK(strchr(line, '#') == NULL);
        began |= strncmp(line, "LABEL=\"isoslice_begin\"", 22) == 0;
        ended |= strncmp(line, "LABEL=\"isoslice_end\"", 20) == 0;
        granted |= strstr(line, "ENV{ISOSLICE_PORT}==\"1\"") && strstr(line, "TAG+=\"uaccess\"") &&
                   strstr(line, "ENV{ID_MM_DEVICE_IGNORE}=\"1\"");
        if (sscanf(line, "ATTRS{idVendor}==\"%4x\", ATTRS{idProduct}==\"%4x\",", &vendor,
                   &product) != 2)
            continue;
        CHECK(began && !ended && !granted);
        CHECK(strstr(line, "ENV{ISOSLICE_PORT}=\"1\"") != NULL);
        if (!CHECK(rule_count < RULES_MOST))
            break;
        rules[rule_count].vendor = vendor;
        rules[rule_count++].product = product;
    }
    CHECK(began && granted && ended);
    fclose(file);
}

static bool ruled(unsigned vendor, unsigned product) {
    for (int i = 0; i < rule_count; i++)
        if (rules[i].vendor == vendor && rules[i].product == product)
            return true;
    return false;
}

static void every_board_is_in_the_rules(void) {
    uint16_t vendor, product;
    int count = 0;
    for (; fio_serial_board_at(count, &vendor, &product); count++)
        if (!CHECK(ruled(vendor, product)))
            fprintf(stderr, "  %04x:%04x\n", vendor, product);
    CHECK(count >= 20);
    CHECK_EQUAL(count, rule_count);
    for (int i = 0; i < rule_count; i++) {
        bool certain;
        CHECK(fio_serial_board((uint16_t)rules[i].vendor, (uint16_t)rules[i].product, &certain));
    }
}

/* From the vendors' own lists. */
static void printers_are_in_the_rules(void) {
    static const unsigned ids[][2] = {{0x2341, 0x0042}, {0x2a03, 0x0042}, {0x0483, 0x5740},
                                      {0x1a86, 0x7523}, {0x0403, 0x6001}, {0x10c4, 0xea60},
                                      {0x067b, 0x2303}, {0x1d50, 0x614e}, {0x2c99, 0x0002}};
    for (size_t i = 0; i < sizeof ids / sizeof *ids; i++)
        CHECK(ruled(ids[i][0], ids[i][1]));
    CHECK(!ruled(0x1d6b, 0x0002)); /* a root hub */
}

int main(int argc, char **argv) {
    if (argc < 2)
        return 2;
    read_rules(argv[1]);
    RUN(every_board_is_in_the_rules);
    RUN(printers_are_in_the_rules);
    return check_verdict();
}
