#include "base/memory.h"
#include "usb/events.h"
#include "usb/transport.h"

struct fio_usb_watch {
    fio_usb_events events;
    bool hotplug;
};

static int LIBUSB_CALL changed(libusb_context *context, libusb_device *device,
                               libusb_hotplug_event event, void *watch) {
    return 0; /* stay; that it woke us is all we want */
}

fio_status fio_usb_watch_open(fio_usb_watch **watch) {
    *watch = NULL;
    fio_usb_watch *self = fio_allocate(sizeof *self);
    if (!self)
        return fio_fail(FIO_NO_MEMORY, "no memory to watch USB");
    fio_status status = fio_usb_events_open(&self->events);
    if (status != FIO_OK) {
        fio_release(self);
        return status;
    }
    self->hotplug = libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) &&
                    libusb_hotplug_register_callback(
                        self->events.context,
                        LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT, 0,
                        LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY,
                        LIBUSB_HOTPLUG_MATCH_ANY, changed, self, NULL) == LIBUSB_SUCCESS;
    *watch = self;
    return FIO_OK;
}

fio_status fio_usb_watch_wait(fio_usb_watch *watch, double seconds) {
    double most = watch->hotplug ? 1 : 0.2; /* an event may be missed while udev is down */
    return fio_usb_events_wait(&watch->events, NULL, 0, seconds < most ? seconds : most);
}

void fio_usb_watch_close(fio_usb_watch *watch) {
    if (!watch)
        return;
    fio_usb_events_close(&watch->events);
    fio_release(watch);
}
