/* Which port a name means, on tables of ports made up here. */
#include "check.h"

#include "port/choose.h"

#include <stdlib.h>

static fio_port_table *table;

static void clear(void) {
    memset(table, 0, sizeof *table);
}

static fio_port_entry *add_usb(const char *name, const char *place, bool certain) {
    fio_usb_found *found = &table->found[table->found_count++];
    found->vendor = (uint16_t)strtol(name + 4, NULL, 16);
    found->product = (uint16_t)strtol(name + 9, NULL, 16);
    found->known = true;
    snprintf(found->serial, sizeof found->serial, "%s", name[13] == ':' ? name + 14 : "");
    snprintf(found->place, sizeof found->place, "%s", place);
    fio_port_entry *entry = &table->entries[table->count++];
    entry->usb = found;
    entry->port.certain = certain;
    entry->port.allowed = true;
    snprintf(entry->port.name, sizeof entry->port.name, "%s", name);
    return entry;
}

static fio_port_entry *add_tty(const char *path, bool certain) {
    fio_port_entry *entry = &table->entries[table->count++];
    entry->port.certain = certain;
    entry->port.allowed = true;
    snprintf(entry->port.name, sizeof entry->port.name, "tty:%s", path);
    snprintf(entry->port.tty, sizeof entry->port.tty, "%s", path);
    return entry;
}

static bool says(const char *text) {
    return strstr(fio_error_message(), text) != NULL;
}

static void automatic(void) {
    const fio_port_entry *chosen;
    clear();
    CHECK_EQUAL(FIO_NO_PRINTER, fio_port_choose(&chosen, table));
    CHECK(!chosen && says("no printer found"));

    fio_port_entry *bridge = add_usb("usb:1a86:7523", "1-1", false);
    CHECK_EQUAL(FIO_OK, fio_port_choose(&chosen, table));
    CHECK(chosen == bridge);

    add_usb("usb:0403:6001:A5", "1-2", false);
    CHECK_EQUAL(FIO_NO_PRINTER, fio_port_choose(&chosen, table));
    CHECK(!chosen && says("usb:1a86:7523, usb:0403:6001:A5") && says("--port"));

    fio_port_entry *mega = add_usb("usb:2341:0042:55", "1-3", true);
    CHECK_EQUAL(FIO_OK, fio_port_choose(&chosen, table));
    CHECK(chosen == mega);

    add_usb("usb:2c99:0002:CZ", "1-4", true);
    CHECK_EQUAL(FIO_NO_PRINTER, fio_port_choose(&chosen, table));
    CHECK(says("2 ports with printers: usb:2341:0042:55, usb:2c99:0002:CZ"));
}

/* A device that may be opened only as the kernel's tty is one port, not two. */
static void tty_of_a_forbidden_device(void) {
    const fio_port_entry *chosen;
    clear();
    fio_port_entry *mega = add_usb("usb:2341:0042:55", "1-3", true);
    mega->port.allowed = false;
    snprintf(mega->port.tty, sizeof mega->port.tty, "/dev/ttyACM0");
    CHECK_EQUAL(FIO_OK, fio_port_choose(&chosen, table));
    CHECK(chosen == mega);
    fio_port_entry *tty = add_tty("/dev/ttyACM0", true);
    CHECK_EQUAL(FIO_OK, fio_port_choose(&chosen, table));
    CHECK(chosen == tty);
}

static void by_name(void) {
    const fio_usb_found *found;
    clear();
    add_usb("usb:2341:0042:55", "1-3", true);
    add_usb("usb:1a86:7523", "1-1.2", false);
    add_usb("usb:1a86:7523", "1-1.4", false);
    CHECK_EQUAL(FIO_OK, fio_port_choose_usb(&found, table, "usb:2341:0042"));
    CHECK_EQUAL(FIO_OK, fio_port_choose_usb(&found, table, "usb:2341:0042:55"));
    CHECK(found == &table->found[0]);
    CHECK_EQUAL(FIO_NO_PRINTER, fio_port_choose_usb(&found, table, "usb:2341:0042:56"));
    CHECK(says("not there; what is: usb:2341:0042:55"));
    CHECK_EQUAL(FIO_NO_PRINTER, fio_port_choose_usb(&found, table, "usb:1a86:7523"));
    CHECK(says("there are 2 of them"));
    CHECK_EQUAL(FIO_OK, fio_port_choose_usb(&found, table, "usb:1A86:7523@1-1.4"));
    CHECK(found == &table->found[2]);
    CHECK_EQUAL(FIO_NO_PRINTER, fio_port_choose_usb(&found, table, "usb:1a86:7523@1-1"));
}

static void what_is_no_serial_port(void) {
    const fio_usb_found *found;
    clear();
    table->found[0] = (fio_usb_found){.vendor = 0x046d, .product = 0xc077, .label = "Mouse"};
    table->found_count = 1;
    CHECK_EQUAL(FIO_NO_PRINTER, fio_port_choose_usb(&found, table, "usb:046d:c077"));
    CHECK(says("\"Mouse\" is no serial port"));
    CHECK_EQUAL(FIO_NO_PRINTER, fio_port_choose_usb(&found, table, "usb:046d:c078"));
    CHECK(says("plugged in"));
}

/* However many there are, the message is cut and nothing overrun. */
static void a_crowd(void) {
    const fio_port_entry *chosen;
    char name[64], place[16];
    clear();
    for (int i = 0; i < FIO_USB_DEVICES; i++) {
        snprintf(name, sizeof name, "usb:2341:0042:a-long-number-of-a-board-%d", i);
        snprintf(place, sizeof place, "1-%d", i);
        add_usb(name, place, true);
    }
    CHECK_EQUAL(FIO_NO_PRINTER, fio_port_choose(&chosen, table));
    CHECK(says("there are 256 ports"));
}

static void names(void) {
    static const char *const good[] = {"usb:2341:0042", "usb:1A86:7523:x", "usb:0403:6001@2-1.3"};
    static const char *const bad[] = {"usb:",           "usb:2341",       "usb:2341:004",
                                      "usb:2341:0042:", "usb:2341:0042@", "usb:2341:00421",
                                      "usb:234g:0042",  "usb:2341-0042",  "usb:2341:0042/x"};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++)
        CHECK(fio_port_usb_name(good[i]));
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        if (!CHECK(!fio_port_usb_name(bad[i])))
            fprintf(stderr, "  %s\n", bad[i]);
}

int main(void) {
    table = calloc(1, sizeof *table);
    RUN(automatic);
    RUN(tty_of_a_forbidden_device);
    RUN(by_name);
    RUN(what_is_no_serial_port);
    RUN(a_crowd);
    RUN(names);
    free(table);
    return check_verdict();
}
