#include "port/list.h"

#include "base/memory.h"
#include "transport/tty.h"
#include "usb/trouble.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --- names -------------------------------------------------------------------------------------*/

static bool simple(const char *serial) {
    for (const char *c = serial; *c; c++)
        if (!isalnum((unsigned char)*c) && !strchr("-_.", *c))
            return false;
    return serial[0] != 0;
}

static void base_name(char *name, size_t capacity, const fio_usb_found *found) {
    int length = snprintf(name, capacity, "usb:%04x:%04x", found->vendor, found->product);
    if (simple(found->serial))
        snprintf(name + length, capacity - (size_t)length, ":%s", found->serial);
}

/* Whether its serial number tells it from all others. */
static bool unique(const char *name, const fio_usb_found *found, const fio_port_table *table) {
    char other[128];
    for (int i = 0; i < table->found_count; i++) {
        const fio_usb_found *one = &table->found[i];
        if (one == found || one->vendor != found->vendor || one->product != found->product)
            continue;
        base_name(other, sizeof other, one);
        if (strcmp(name, other) == 0)
            return false;
    }
    return true;
}

static bool four_digits(const char *text) {
    for (int i = 0; i < 4; i++)
        if (!isxdigit((unsigned char)text[i]))
            return false;
    return true;
}

bool fio_port_usb_name(const char *name) {
    return strlen(name) >= 13 && four_digits(name + 4) && name[8] == ':' && four_digits(name + 9) &&
           (name[13] == 0 || ((name[13] == ':' || name[13] == '@') && name[14]));
}

bool fio_port_names(const char *name, const fio_usb_found *found) {
    if (strtol(name + 4, NULL, 16) != found->vendor || strtol(name + 9, NULL, 16) != found->product)
        return false;
    if (name[13] == '@')
        return strcmp(name + 14, found->place) == 0;
    return name[13] == 0 || strcmp(name + 14, found->serial) == 0;
}

/* --- USB ---------------------------------------------------------------------------------------*/

static fio_port_entry *add(fio_port_table *table, const fio_usb_found *usb) {
    if (table->count == FIO_PORTS_MOST)
        return NULL;
    fio_port_entry *entry = &table->entries[table->count++];
    *entry = (fio_port_entry){.usb = usb};
    return entry;
}

static void describe_usb(fio_port *port, const fio_usb_found *found, const fio_port_table *table) {
    bool certain;
    const char *board = fio_serial_board(found->vendor, found->product, &certain);
    if (!board)
        board = found->label[0] ? found->label : "serial port";
    char name[sizeof port->name];
    base_name(name, sizeof name, found);
    if (!unique(name, found, table))
        snprintf(name, sizeof name, "usb:%04x:%04x@%s", found->vendor, found->product,
                 found->place);
    memcpy(port->name, name, sizeof name);
    snprintf(port->driver, sizeof port->driver, "%s", found->link.driver->name);
    snprintf(port->board, sizeof port->board, "%s", board);
    snprintf(port->serial, sizeof port->serial, "%s", found->serial);
    snprintf(port->tty, sizeof port->tty, "%s", found->tty);
    port->vendor = found->vendor;
    port->product = found->product;
    port->certain = certain;
    port->allowed = fio_usb_allowed(found);
    if (!port->allowed)
        fio_usb_explain_access(port->reason, sizeof port->reason, found);
}

static void read_usb(fio_port_table *table) {
    table->found_count = fio_usb_list(table->found);
    for (int i = 0; i < table->found_count; i++) {
        fio_port_entry *entry = table->found[i].known ? add(table, &table->found[i]) : NULL;
        if (entry)
            describe_usb(&entry->port, &table->found[i], table);
    }
}

/* --- ttys --------------------------------------------------------------------------------------*/

static const fio_port_entry *usb_of(const fio_port_table *table, const char *tty) {
    for (int i = 0; i < table->count; i++)
        if (table->entries[i].usb && strcmp(table->entries[i].port.tty, tty) == 0)
            return &table->entries[i];
    return NULL;
}

static bool listed(const fio_port_table *table, const char *tty) {
    for (int i = 0; i < table->count; i++)
        if (!table->entries[i].usb && strcmp(table->entries[i].port.tty, tty) == 0)
            return true;
    return false;
}

static void add_tty(fio_port_table *table, const char *path, const char *label) {
    const fio_port_entry *usb = usb_of(table, path);
    bool allowed = access(path, R_OK | W_OK) == 0;
    if (listed(table, path) || (usb && (usb->port.allowed || !allowed)))
        return;
    fio_port_entry *entry = add(table, NULL);
    if (!entry)
        return;
    if (usb)
        entry->port = usb->port;
    else
        snprintf(entry->port.board, sizeof entry->port.board, "%.63s", label);
    snprintf(entry->port.name, sizeof entry->port.name, "tty:%.100s", path);
    snprintf(entry->port.driver, sizeof entry->port.driver, "tty");
    snprintf(entry->port.tty, sizeof entry->port.tty, "%.63s", path);
    entry->port.reason[0] = 0;
    entry->port.allowed = allowed;
    if (!allowed)
        fio_tty_explain(entry->port.reason, sizeof entry->port.reason, path, EACCES);
}

/* The names there tell what the port is: usb-Vendor_Product_Serial-if00. */
static void read_by_id(fio_port_table *table) {
    static const char folder[] = "/dev/serial/by-id";
    DIR *links = opendir(folder);
    for (struct dirent *link; links && (link = readdir(links));) {
        char path[400], target[300];
        snprintf(path, sizeof path, "%s/%s", folder, link->d_name);
        ssize_t length = readlink(path, target, sizeof target - 1);
        if (length <= 0)
            continue;
        target[length] = 0;
        const char *slash = strrchr(target, '/');
        snprintf(path, sizeof path, "/dev/%s", slash ? slash + 1 : target);
        add_tty(table, path, link->d_name);
    }
    if (links)
        closedir(links);
}

static void read_ttys(fio_port_table *table) {
    DIR *devices = opendir("/dev");
    for (struct dirent *device; devices && (device = readdir(devices));) {
        char path[300];
        snprintf(path, sizeof path, "/dev/%s", device->d_name);
        if (strncmp(device->d_name, "ttyACM", 6) == 0 || strncmp(device->d_name, "ttyUSB", 6) == 0)
            add_tty(table, path, "serial port");
    }
    if (devices)
        closedir(devices);
}

/* --- both --------------------------------------------------------------------------------------*/

static int in_order(const void *one, const void *other) {
    const fio_port *a = &((const fio_port_entry *)one)->port;
    const fio_port *b = &((const fio_port_entry *)other)->port;
    return a->certain != b->certain ? (a->certain ? -1 : 1) : strcmp(a->name, b->name);
}

void fio_port_table_read(fio_port_table *table) {
    table->count = 0;
    read_usb(table);
    read_by_id(table);
    read_ttys(table);
    qsort(table->entries, (size_t)table->count, sizeof *table->entries, in_order);
}

fio_status fio_ports_list(fio_port **ports, int *count) {
    *ports = NULL;
    *count = 0;
    fio_port_table *table = fio_allocate(sizeof *table);
    if (!table)
        return fio_fail(FIO_NO_MEMORY, "no memory for the list of ports");
    fio_port_table_read(table);
    fio_port *list = table->count ? fio_allocate((size_t)table->count * sizeof *list) : NULL;
    int entries = table->count;
    for (int i = 0; list && i < entries; i++)
        list[i] = table->entries[i].port;
    fio_release(table);
    if (entries && !list)
        return fio_fail(FIO_NO_MEMORY, "no memory for the list of ports");
    *ports = list;
    *count = entries;
    return FIO_OK;
}

void fio_ports_free(fio_port *ports) {
    fio_release(ports);
}
