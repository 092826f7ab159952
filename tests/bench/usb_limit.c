/* The most that a USB stand-in carries: `usb-limit COUNT` opens its cdc-acm device as simply as
 * libusb allows, sends as many lines, each once the one before is answered, and prints lines a
 * second. */
#include <libusb.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { VENDOR = 0x2341, PRODUCT = 0x0042, OUT = 0x02, IN = 0x83, TIMEOUT = 10000 };

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static void must(int good, const char *what) {
    if (good)
        return;
    fprintf(stderr, "usb-limit: %s\n", what);
    exit(1);
}

/* Read until `lines` lines have begun with "ok". */
static void wait_for_oks(libusb_device_handle *handle, int lines) {
    static char held[4096];
    static size_t size;
    while (lines > 0) {
        int got = 0;
        int error =
            libusb_bulk_transfer(handle, IN, (unsigned char *)held + size, 512, &got, TIMEOUT);
        must(error == 0 || got > 0, "nothing comes back");
        size += (size_t)got;
        size_t at = 0;
        for (char *end; (end = memchr(held + at, '\n', size - at)); at = (size_t)(end - held) + 1)
            lines -= strncmp(held + at, "ok", 2) == 0;
        size -= at;
        memmove(held, held + at, size);
        must(size < sizeof held - 512, "an endless line");
    }
}

static void send_line(libusb_device_handle *handle, const char *line) {
    int sent = 0, size = (int)strlen(line);
    int error = libusb_bulk_transfer(handle, OUT, (unsigned char *)line, size, &sent, TIMEOUT);
    must(error == 0 && sent == size, libusb_strerror(error));
}

int main(int argc, char **argv) {
    int count = argc == 2 ? atoi(argv[1]) : 0;
    must(count > 0 && libusb_init(NULL) == 0, "usage: usb-limit COUNT, where there is USB");
    libusb_device_handle *handle = libusb_open_device_with_vid_pid(NULL, VENDOR, PRODUCT);
    must(handle != NULL, "no device");
    must(libusb_claim_interface(handle, 0) == 0 && libusb_claim_interface(handle, 1) == 0,
         "its interfaces are taken");
    must(libusb_control_transfer(handle, 0x21, 0x22, 3, 0, NULL, 0, TIMEOUT) == 0, "no DTR");
    send_line(handle, "G28\n");
    wait_for_oks(handle, 1);
    double begun = now();
    for (int i = 0; i < count; i++) {
        send_line(handle, "G1 X100.000 Y100.000 F9000 E0.00000\n");
        wait_for_oks(handle, 1);
    }
    printf("%.1f\n", count / (now() - begun));
    libusb_release_interface(handle, 1);
    libusb_release_interface(handle, 0);
    libusb_close(handle);
    libusb_exit(NULL);
    return 0;
}
