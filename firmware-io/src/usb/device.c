#include "usb/device.h"

#include <ctype.h>
#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char root[] = "/sys/bus/usb/devices";

enum { DESCRIPTORS_MOST = 4096, CLASS_HUB = 9 };

/* A whole file of at most `capacity` bytes; its size, 0 if there is none. */
static size_t read_file(const char *device, const char *name, void *bytes, size_t capacity) {
    char path[400];
    snprintf(path, sizeof path, "%s/%s/%s", root, device, name);
    int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return 0;
    size_t size = 0;
    ssize_t got;
    while (size < capacity && (got = read(file, (char *)bytes + size, capacity - size)) > 0)
        size += (size_t)got;
    close(file);
    return size;
}

/* A line of text that the device chose: no control bytes of its own reach a terminal. */
static void read_text(const char *device, const char *name, char *text, size_t capacity) {
    size_t size = read_file(device, name, text, capacity - 1);
    while (size > 0 && (text[size - 1] == '\n' || text[size - 1] == ' '))
        size--;
    text[size] = 0;
    for (size_t i = 0; i < size; i++)
        if ((unsigned char)text[i] < ' ' || text[i] == 127)
            text[i] = '?';
}

static int read_number(const char *device, const char *name) {
    char text[16];
    read_text(device, name, text, sizeof text);
    return atoi(text);
}

/* The first entry of a folder whose name begins with `prefix`. */
static bool first_entry(char *name, size_t capacity, const char *folder, const char *prefix) {
    DIR *entries = opendir(folder);
    bool any = false;
    for (struct dirent *entry; entries && !any && (entry = readdir(entries));) {
        any = entry->d_name[0] != '.' && strncmp(entry->d_name, prefix, strlen(prefix)) == 0 &&
              strlen(entry->d_name) < capacity;
        if (any)
            snprintf(name, capacity, "%s", entry->d_name);
    }
    if (entries)
        closedir(entries);
    return any;
}

/* cdc_acm has 1-2:1.0/tty/ttyACM0, the bridges' drivers have 1-2:1.0/ttyUSB0. */
static void find_tty(fio_usb_found *found, const char *interface) {
    char folder[360], name[26];
    snprintf(folder, sizeof folder, "%s/%.40s/tty", root, interface);
    if (!first_entry(name, sizeof name, folder, "tty")) {
        folder[strlen(folder) - 4] = 0;
        if (!first_entry(name, sizeof name, folder, "ttyUSB"))
            return;
    }
    snprintf(found->tty, sizeof found->tty, "/dev/%s", name);
}

static void find_driver(fio_usb_found *found, const char *interface) {
    char path[360], target[300];
    snprintf(path, sizeof path, "%s/%.40s/driver", root, interface);
    ssize_t length = readlink(path, target, sizeof target - 1);
    if (length <= 0)
        return;
    target[length] = 0;
    const char *slash = strrchr(target, '/');
    snprintf(found->kernel, sizeof found->kernel, "%.31s", slash ? slash + 1 : target);
}

/* What the kernel made of the interface that we would claim first: "1-2:1.0", configuration and
 * number behind the place. */
static void look_at_kernel(fio_usb_found *found) {
    char interface[64];
    snprintf(interface, sizeof interface, "%s:%d.%d", found->place, found->configuration,
             found->link.interfaces[0]);
    find_driver(found, interface);
    find_tty(found, interface);
}

static bool look_at(fio_usb_found *found, const char *place) {
    static const fio_usb_found none;
    uint8_t bytes[DESCRIPTORS_MOST];
    fio_usb_device device;
    size_t size = read_file(place, "descriptors", bytes, sizeof bytes);
    *found = none;
    if (!fio_usb_device_read(&device, bytes, size) || device.class_code == CLASS_HUB)
        return false;
    snprintf(found->place, sizeof found->place, "%s", place);
    found->bus = read_number(place, "busnum");
    found->address = read_number(place, "devnum");
    if (found->bus < 1 || found->bus > 999 || found->address < 1 || found->address > 999)
        return false;
    snprintf(found->node, sizeof found->node, "/dev/bus/usb/%03d/%03d", found->bus, found->address);
    found->vendor = device.vendor;
    found->product = device.product;
    read_text(place, "serial", found->serial, sizeof found->serial);
    read_text(place, "product", found->label, sizeof found->label);
    found->configuration = read_number(place, "bConfigurationValue");
    found->known = fio_serial_match(&found->link, &device);
    if (found->known)
        look_at_kernel(found);
    return true;
}

static int by_place(const void *one, const void *other) {
    return strcmp(((const fio_usb_found *)one)->place, ((const fio_usb_found *)other)->place);
}

int fio_usb_list(fio_usb_found *found) {
    int count = 0;
    DIR *devices = opendir(root);
    for (struct dirent *device; devices && (device = readdir(devices));)
        /* "1-2.3", but neither its interfaces "1-2.3:1.0" nor root hubs "usb1" */
        if (isdigit((unsigned char)device->d_name[0]) && !strchr(device->d_name, ':') &&
            strlen(device->d_name) < sizeof found->place && count < FIO_USB_DEVICES)
            count += look_at(&found[count], device->d_name);
    if (devices)
        closedir(devices);
    qsort(found, (size_t)count, sizeof *found, by_place);
    return count;
}

bool fio_usb_allowed(const fio_usb_found *found) {
    return found->configuration > 0 && access(found->node, R_OK | W_OK) == 0;
}
