#define _GNU_SOURCE /* pipe2() */
#include "standin/mock.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "standin/umockdev.h"

static const char preload[] = "libumockdev-preload.so.0";

typedef struct mock {
    fio_standin standin;
    fio_virtual_usb *device;
    fio_usb_host host;
    const fio_umockdev_module *module;
    fio_umockdev *node;
    int wake[2]; /* a pipe: the loop has to look again */
    bool waked;
} mock;

/* Whoever changed what is done tells the node, and the loop: its next look may be too late. */
static void changed(mock *m) {
    m->module->gate(m->node, m->host.done.first != NULL);
}

static void wake(mock *m) {
    if (!m->waked)
        m->waked = write(m->wake[1], "", 1) == 1;
}

static void turn(mock *m) {
    if (fio_standin_turn(&m->standin, NULL, 0) == FIO_OK)
        changed(m);
    m->standin.heard = true; /* the loop clears it */
    wake(m);
}

/* --- called by the module, on its thread, all after lock() --- */

static void lock(void *context) {
    pthread_mutex_lock(&((mock *)context)->standin.lock);
}

static void unlock(void *context) {
    pthread_mutex_unlock(&((mock *)context)->standin.lock);
}

static void submit(void *context, fio_urb *urb) {
    mock *m = context;
    m->standin.connected = true;
    m->standin.jumps = 0;
    fio_usb_host_submit(&m->host, fio_pace_now(m->standin.pace), urb);
    turn(m);
}

static bool cancel(void *context, const fio_urb *urb, int status) {
    mock *m = context;
    bool found = fio_usb_host_cancel(&m->host, urb, status);
    changed(m);
    return found;
}

static fio_urb *reap(void *context, const void *client) {
    mock *m = context;
    fio_urb *urb = fio_usb_host_reap(&m->host, client);
    changed(m);
    return urb;
}

static void clear_halt(void *context, uint8_t endpoint) {
    mock *m = context;
    fio_usb_host_clear_halt(&m->host, fio_pace_now(m->standin.pace), endpoint);
    turn(m);
}

/* --- called by the loop --- */

static fio_status serve(fio_standin *standin, double now, const struct pollfd *polls, int count) {
    mock *m = (mock *)standin;
    char bytes[16];
    if (count > 0 && polls[0].revents && read(m->wake[0], bytes, sizeof bytes) > 0)
        m->waked = false;
    if (!fio_machine_plugged(standin->machine) && !m->host.gone) {
        fio_usb_host_unplug(&m->host);
        changed(m);
    }
    standin->told = fio_usb_host_pump(&m->host, now);
    if (standin->told)
        changed(m);
    return FIO_OK;
}

static int polls_of(fio_standin *standin, struct pollfd *polls, int most) {
    polls[0] = (struct pollfd){((mock *)standin)->wake[0], POLLIN, 0};
    return 1;
}

static double next(const fio_standin *standin) {
    return fio_usb_host_next(&((const mock *)standin)->host);
}

static fio_status plug(fio_standin *standin, bool in) {
    mock *m = (mock *)standin;
    if (in)
        fio_usb_host_begin(&m->host, m->device, standin->machine);
    if (!m->module->plug(m->node, in))
        return fio_fail(FIO_NOT_WRITTEN, "umockdev: the device can't be plugged in again");
    return FIO_OK;
}

static void close_it(fio_standin *standin) {
    mock *m = (mock *)standin;
    if (m->node)
        m->module->close(m->node);
    for (int i = 0; i < 2; i++)
        if (m->wake[i] >= 0)
            close(m->wake[i]);
}

void fio_mock_bound(fio_standin *standin, int *now, int *first) {
    mock *m = (mock *)standin;
    pthread_mutex_lock(&standin->lock);
    m->module->bound(m->node, now, first);
    pthread_mutex_unlock(&standin->lock);
}

/* Beside the program as it was built, where it is installed, or where ISOPRINT_UMOCKDEV says. */
static void *open_module(char *tried, size_t size) {
    const char *named = getenv("ISOPRINT_UMOCKDEV");
    char self[3800], path[4000];
    ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    self[length > 0 ? length : 0] = 0;
    char *slash = strrchr(self, '/');
    if (slash)
        *slash = 0;
    const char *const formats[] = {"%s/isoprint-umockdev.so",
                                   "%s/../src/standin/isoprint-umockdev.so",
                                   "%s/../" FIO_MODULE_FOLDER "/isoprint-umockdev.so"};
    void *module = named ? dlopen(named, RTLD_NOW | RTLD_LOCAL) : NULL;
    for (size_t i = 0; !module && !named && i < sizeof formats / sizeof *formats; i++) {
        snprintf(path, sizeof path, formats[i], self);
        if (access(path, F_OK) == 0 || i == 2) {
            module = dlopen(path, RTLD_NOW | RTLD_LOCAL);
            break;
        }
    }
    const char *error = module ? NULL : dlerror();
    snprintf(tried, size, "%s", error ? error : "");
    return module;
}

static fio_status load(const fio_umockdev_module **table) {
    static const char advice[] =
        "it comes with isoprint-virtual where libumockdev-dev is there when it is built, and needs "
        "the packages umockdev and libumockdev0";
    char error[512];
    void *module = open_module(error, sizeof error);
    if (!module)
        return fio_fail(FIO_NOT_WRITTEN, "no module for devices of umockdev (%s): %s", error,
                        advice);
    *table = dlsym(module, FIO_UMOCKDEV_ENTRY);
    if (!*table || (*table)->version != FIO_UMOCKDEV_VERSION)
        return fio_fail(FIO_NOT_WRITTEN, "isoprint-umockdev.so is of another version: %s", advice);
    return FIO_OK;
}

fio_status fio_mock_preload(char **argv) {
    const char *old = getenv("LD_PRELOAD");
    if (old && strstr(old, "libumockdev-preload"))
        return FIO_OK;
    size_t length = (old ? strlen(old) : 0) + sizeof preload + 2;
    char *both = fio_allocate(length);
    if (!both)
        return fio_fail(FIO_NO_MEMORY, "no memory for an environment");
    snprintf(both, length, "%s%s%s", old ? old : "", old && *old ? ":" : "", preload);
    setenv("LD_PRELOAD", both, 1);
    fio_release(both);
    void *found = dlopen(preload, RTLD_LAZY | RTLD_LOCAL);
    if (!found)
        return fio_fail(FIO_NOT_WRITTEN, "%s is not there: install the package umockdev", preload);
    execv("/proc/self/exe", argv);
    return fio_fail(FIO_NOT_WRITTEN, "can't be executed again: %s", strerror(errno));
}

static fio_status plug_in(mock *m, const fio_mock_options *options) {
    char reason[256];
    size_t size;
    const uint8_t *bytes = fio_virtual_usb_descriptors(m->device, &size);
    const fio_umockdev_host host = {m, lock, unlock, submit, cancel, reap, clear_halt};
    fio_umockdev_device device = {
        .descriptors = bytes,
        .size = size,
        .manufacturer = bytes[14] ? fio_virtual_usb_string(m->device, bytes[14]) : NULL,
        .product = bytes[15] ? fio_virtual_usb_string(m->device, bytes[15]) : NULL,
        .serial = bytes[16] ? fio_virtual_usb_string(m->device, bytes[16]) : NULL,
        .denied = options->denied,
        .bound = options->bound,
    };
    for (int i = 0; i < FIO_USB_ENDPOINTS; i++)
        device.high_speed |= m->host.packet[i] > 64;
    m->node = m->module->open(&host, &device, reason);
    if (!m->node)
        return fio_fail(FIO_NOT_WRITTEN, "%s", reason);
    snprintf(m->standin.where, sizeof m->standin.where, "usb:%02x%02x:%02x%02x%s%s", bytes[9],
             bytes[8], bytes[11], bytes[10], device.serial ? ":" : "",
             device.serial ? device.serial : "");
    return FIO_OK;
}

fio_status fio_standin_mock(fio_standin **standin, fio_machine *machine, fio_pace *pace,
                            fio_virtual_usb *device, const fio_mock_options *options) {
    static const fio_standin_type type = {"umockdev", polls_of, serve, next, plug, close_it};
    const fio_umockdev_module *module;
    *standin = NULL;
    fio_status status = load(&module);
    if (status != FIO_OK)
        return status;
    mock *m = fio_allocate(sizeof *m);
    if (!m)
        return fio_fail(FIO_NO_MEMORY, "no memory for a device of umockdev");
    fio_standin_begin(&m->standin, &type, machine, pace);
    m->device = device;
    m->module = module;
    fio_usb_host_begin(&m->host, device, machine);
    m->host.stall_at = options->stall_at;
    m->wake[0] = m->wake[1] = -1;
    if (pipe2(m->wake, O_CLOEXEC | O_NONBLOCK) != 0)
        status = fio_fail(FIO_NOT_WRITTEN, "no pipe to be had: %s", strerror(errno));
    if (status == FIO_OK)
        status = plug_in(m, options);
    if (status == FIO_OK)
        *standin = &m->standin;
    else
        fio_standin_close(&m->standin);
    return status;
}
