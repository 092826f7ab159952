#define _GNU_SOURCE /* F_SETPIPE_SZ */
#include "standin/umockdev.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <umockdev.h>
#include <unistd.h>

#include "standin/usb_claim.h"

/* A URB of a client: its struct and its buffer, copied here and written back when it is reaped. */
typedef struct mock_urb {
    fio_urb urb;
    UMockdevIoctlData *theirs, *buffer;
    struct mock_urb *next; /* of all that are not reaped, newest first */
} mock_urb;

struct fio_umockdev {
    fio_umockdev_host host;
    fio_umockdev_device device;
    UMockdevTestbed *testbed;
    UMockdevIoctlBase *ioctls;
    fio_usb_claims claims;
    mock_urb *urbs;
    int number; /* of the device on its bus; another one each time it is plugged in */
    int gate;   /* the FIFO that stands in for the node; -1 */
    bool gate_open, gone;
    char node[64];
};

static const char sys_path[] = "/sys/devices/usb1/1-2";

static struct usbdevfs_urb *kernel_urb(const mock_urb *urb) {
    return (struct usbdevfs_urb *)urb->theirs->data;
}

static void release_urb(fio_umockdev *mock, mock_urb *urb) {
    for (mock_urb **at = &mock->urbs; *at; at = &(*at)->next)
        if (*at == urb) {
            *at = urb->next;
            break;
        }
    if (urb->buffer)
        umockdev_ioctl_data_unref(urb->buffer);
    umockdev_ioctl_data_unref(urb->theirs);
    g_free(urb);
}

static char *node_path(const fio_umockdev *mock) {
    char *root = umockdev_testbed_get_root_dir(mock->testbed);
    char *path = g_build_filename(root, mock->node, NULL);
    g_free(root);
    return path;
}

/* umockdev's nodes are regular files, at which poll() never waits: libusb would turn round and
 * round. A FIFO can be made to look full instead. */
static bool replace_node(fio_umockdev *mock) {
    char *path = node_path(mock);
    bool done = unlink(path) == 0 && mkfifo(path, 0666) == 0;
    mock->gate = done ? open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC) : -1;
    done = mock->gate >= 0 && fcntl(mock->gate, F_SETPIPE_SZ, 4096) >= 0 &&
           write(mock->gate, "", 1) == 1 && chmod(path, mock->device.denied ? 0 : 0666) == 0;
    mock->gate_open = false;
    g_free(path);
    return done;
}

static void gate(fio_umockdev *mock, bool open) {
    char byte = 0;
    if (mock->gate < 0 || open == mock->gate_open)
        return;
    ssize_t moved = open ? read(mock->gate, &byte, 1) : write(mock->gate, &byte, 1);
    if (moved == 1) /* one byte in a pipe of one page makes it full, to poll() */
        mock->gate_open = open;
}

static int submit(fio_umockdev *mock, UMockdevIoctlClient *client, UMockdevIoctlData *arg) {
    mock_urb *made = g_new0(mock_urb, 1);
    made->theirs = umockdev_ioctl_data_resolve(arg, 0, sizeof(struct usbdevfs_urb), NULL);
    if (!made->theirs) {
        g_free(made);
        return EFAULT;
    }
    struct usbdevfs_urb *urb = kernel_urb(made);
    made->next = mock->urbs;
    mock->urbs = made;
    bool control = urb->type == USBDEVFS_URB_TYPE_CONTROL;
    if (urb->type == USBDEVFS_URB_TYPE_ISO || urb->buffer_length < (control ? 8 : 0)) {
        release_urb(mock, made);
        return EINVAL;
    }
    if (urb->buffer_length)
        made->buffer =
            umockdev_ioctl_data_resolve(made->theirs, G_STRUCT_OFFSET(struct usbdevfs_urb, buffer),
                                        (size_t)urb->buffer_length, NULL);
    if (urb->buffer_length && !made->buffer) {
        release_urb(mock, made);
        return EFAULT;
    }
    made->urb = (fio_urb){.endpoint = control ? 0 : urb->endpoint,
                          .data = made->buffer ? made->buffer->data : NULL,
                          .length = urb->buffer_length,
                          .empty_packet = (urb->flags & USBDEVFS_URB_ZERO_PACKET) != 0,
                          .owner = made,
                          .client = client};
    if (control) {
        memcpy(made->urb.setup, made->buffer->data, 8);
        made->urb.data += 8;
        made->urb.length -= 8;
    }
    mock->host.submit(mock->host.context, &made->urb);
    return 0;
}

static int discard(fio_umockdev *mock, UMockdevIoctlClient *client, UMockdevIoctlData *arg) {
    gulong wanted = *(gulong *)arg->data;
    for (mock_urb *urb = mock->urbs; urb; urb = urb->next)
        if (urb->theirs->client_addr == wanted && urb->urb.client == client &&
            mock->host.cancel(mock->host.context, &urb->urb, -ENOENT))
            return 0;
    return EINVAL;
}

static int reap(fio_umockdev *mock, UMockdevIoctlClient *client, UMockdevIoctlData *arg) {
    fio_urb *done = mock->host.reap(mock->host.context, client);
    if (!done)
        return mock->gone ? ENODEV : EAGAIN;
    mock_urb *urb = done->owner;
    kernel_urb(urb)->status = done->status;
    kernel_urb(urb)->actual_length = done->moved;
    UMockdevIoctlData *pointer = umockdev_ioctl_data_resolve(arg, 0, sizeof(gpointer), NULL);
    bool given = pointer && umockdev_ioctl_data_set_ptr(pointer, 0, urb->theirs);
    if (pointer)
        umockdev_ioctl_data_unref(pointer);
    release_urb(mock, urb);
    return given ? 0 : EFAULT;
}

static int capabilities(UMockdevIoctlData *arg) {
    UMockdevIoctlData *word = umockdev_ioctl_data_resolve(arg, 0, sizeof(guint32), NULL);
    if (!word)
        return EFAULT;
    *(guint32 *)word->data = USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_BULK_CONTINUATION |
                             USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_BULK_SCATTER_GATHER |
                             USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
    umockdev_ioctl_data_unref(word);
    return 0;
}

/* Requests whose argument is a struct that is handed to `answer`. */
static int with_struct(fio_umockdev *mock, UMockdevIoctlClient *client, UMockdevIoctlData *arg,
                       size_t size, int (*answer)(fio_umockdev *, UMockdevIoctlClient *, void *)) {
    UMockdevIoctlData *theirs = umockdev_ioctl_data_resolve(arg, 0, size, NULL);
    if (!theirs)
        return EFAULT;
    int error = answer(mock, client, theirs->data);
    umockdev_ioctl_data_unref(theirs);
    return error;
}

static int get_driver(fio_umockdev *mock, UMockdevIoctlClient *client, void *bytes) {
    struct usbdevfs_getdriver *asked = bytes;
    const char *name = fio_usb_claims_driver(&mock->claims, asked->interface);
    if (name)
        snprintf(asked->driver, sizeof asked->driver, "%s", name);
    return name ? 0 : ENODATA;
}

static int change_driver(fio_umockdev *mock, UMockdevIoctlClient *client, void *bytes) {
    const struct usbdevfs_ioctl *asked = bytes;
    guint32 code = (guint32)asked->ioctl_code;
    if (code == USBDEVFS_DISCONNECT)
        return fio_usb_claims_unbind(&mock->claims, (unsigned)asked->ifno);
    if (code == USBDEVFS_CONNECT)
        return fio_usb_claims_bind(&mock->claims, (unsigned)asked->ifno);
    return ENOTTY;
}

static int detach_and_claim(fio_umockdev *mock, UMockdevIoctlClient *client, void *bytes) {
    const struct usbdevfs_disconnect_claim *asked = bytes;
    if (fio_usb_claims_driver(&mock->claims, asked->interface) &&
        !fio_usb_claims_user(&mock->claims, asked->interface)) {
        int error = fio_usb_claims_unbind(&mock->claims, asked->interface);
        if (error)
            return error;
    }
    return fio_usb_claims_claim(&mock->claims, asked->interface, client);
}

static int claim(fio_umockdev *mock, UMockdevIoctlClient *client, void *bytes) {
    return fio_usb_claims_claim(&mock->claims, *(unsigned *)bytes, client);
}

static int unclaim(fio_umockdev *mock, UMockdevIoctlClient *client, void *bytes) {
    return fio_usb_claims_release(&mock->claims, *(unsigned *)bytes, client);
}

static int clear_halt(fio_umockdev *mock, UMockdevIoctlClient *client, void *bytes) {
    unsigned endpoint = *(unsigned *)bytes;
    mock->host.clear_halt(mock->host.context, (uint8_t)endpoint);
    return 0;
}

static int answer(fio_umockdev *mock, UMockdevIoctlClient *client, guint32 request,
                  UMockdevIoctlData *arg) {
    /* The unsigned type of a request has sizes of structs in it that differ by architecture. */
    if (request == USBDEVFS_REAPURBNDELAY || request == USBDEVFS_REAPURB)
        return reap(mock, client, arg);
    if (mock->gone)
        return ENODEV;
    switch (request) {
    case USBDEVFS_GET_CAPABILITIES:
        return capabilities(arg);
    case USBDEVFS_SUBMITURB:
        return submit(mock, client, arg);
    case USBDEVFS_DISCARDURB:
        return discard(mock, client, arg);
    case USBDEVFS_CLAIMINTERFACE:
        return with_struct(mock, client, arg, sizeof(unsigned), claim);
    case USBDEVFS_RELEASEINTERFACE:
        return with_struct(mock, client, arg, sizeof(unsigned), unclaim);
    case USBDEVFS_DISCONNECT_CLAIM:
        return with_struct(mock, client, arg, sizeof(struct usbdevfs_disconnect_claim),
                           detach_and_claim);
    case USBDEVFS_GETDRIVER:
        return with_struct(mock, client, arg, sizeof(struct usbdevfs_getdriver), get_driver);
    case USBDEVFS_IOCTL:
        return with_struct(mock, client, arg, sizeof(struct usbdevfs_ioctl), change_driver);
    case USBDEVFS_CLEAR_HALT:
        return with_struct(mock, client, arg, sizeof(unsigned), clear_halt);
    case USBDEVFS_RESET:
    case USBDEVFS_SETINTERFACE:
    case USBDEVFS_SETCONFIGURATION:
        return 0;
    default:
        return ENOTTY;
    }
}

static gboolean on_ioctl(UMockdevIoctlBase *base, UMockdevIoctlClient *client, gpointer context) {
    fio_umockdev *mock = context;
    UMockdevIoctlData *arg = umockdev_ioctl_client_get_arg(client); /* borrowed */
    mock->host.lock(mock->host.context);
    int error = answer(mock, client, (guint32)umockdev_ioctl_client_get_request(client), arg);
    mock->host.unlock(mock->host.context);
    umockdev_ioctl_client_complete(client, error ? -1 : 0, error);
    return TRUE;
}

/* As the kernel does when a file is closed: what is under way ends, interfaces are let go. */
static void on_vanished(UMockdevIoctlBase *base, UMockdevIoctlClient *client, gpointer context) {
    fio_umockdev *mock = context;
    mock->host.lock(mock->host.context);
    for (mock_urb *urb = mock->urbs; urb; urb = urb->next)
        if (urb->urb.client == client)
            mock->host.cancel(mock->host.context, &urb->urb, -ENOENT);
    for (fio_urb *done; (done = mock->host.reap(mock->host.context, client));)
        release_urb(mock, done->owner);
    fio_usb_claims_vanish(&mock->claims, client);
    mock->host.unlock(mock->host.context);
}

static void describe_text(GString *text, const char *name, const char *value) {
    if (value)
        g_string_append_printf(text, "A: %s=%s\\n\n", name, value);
}

static char *describe(const fio_umockdev *mock) {
    const fio_umockdev_device *device = &mock->device;
    const uint8_t *bytes = device->descriptors;
    GString *text = g_string_new(NULL);
    g_string_append_printf(
        text,
        "P: /devices/usb1/1-2\nN: bus/usb/001/%03d\nE: SUBSYSTEM=usb\nE: DRIVER=usb\n"
        "E: BUSNUM=001\nE: DEVNUM=%03d\nE: DEVNAME=%s\nE: DEVTYPE=usb_device\nE: MAJOR=189\n"
        "E: MINOR=%d\nA: bConfigurationValue=1\\n\nA: busnum=1\\n\nA: devnum=%d\\n\nA: "
        "speed=%d\\n\nA: idVendor=%02x%02x\\n\nA: idProduct=%02x%02x\\n\n",
        mock->number, mock->number, mock->node, mock->number - 1, mock->number,
        device->high_speed ? 480 : 12, bytes[9], bytes[8], bytes[11], bytes[10]);
    describe_text(text, "manufacturer", device->manufacturer);
    describe_text(text, "product", device->product);
    describe_text(text, "serial", device->serial);
    g_string_append(text, "H: descriptors=");
    for (size_t i = 0; i < device->size; i++)
        g_string_append_printf(text, "%02x", bytes[i]);
    g_string_append(text, "\n");
    return g_string_free(text, FALSE);
}

/* Without the lock, but for the last step. */
static bool add(fio_umockdev *mock, char reason[256]) {
    GError *error = NULL;
    bool done = umockdev_testbed_attach_ioctl(mock->testbed, mock->node, mock->ioctls, &error);
    if (done) {
        char *text = describe(mock);
        done = umockdev_testbed_add_from_string(mock->testbed, text, &error);
        g_free(text);
    }
    snprintf(reason, 256, "umockdev: %s", error ? error->message : "no FIFO can be made");
    if (error)
        g_error_free(error);
    mock->host.lock(mock->host.context);
    done = done && replace_node(mock);
    mock->gone = !done;
    mock->host.unlock(mock->host.context);
    return done;
}

static void name_node(fio_umockdev *mock, int number) {
    mock->number = number;
    snprintf(mock->node, sizeof mock->node, "/dev/bus/usb/001/%03d", number);
    fio_usb_claims_begin(&mock->claims, mock->device.descriptors, mock->device.size,
                         mock->device.bound);
}

static void take_away(fio_umockdev *mock) {
    char *path = node_path(mock);
    unlink(path); /* umockdev itself would leave it */
    g_free(path);
    umockdev_testbed_uevent(mock->testbed, sys_path, "remove");
    umockdev_testbed_remove_device(mock->testbed, sys_path);
    umockdev_testbed_detach_ioctl(mock->testbed, mock->node, NULL);
}

static bool put_back(fio_umockdev *mock) {
    char reason[256];
    if (!add(mock, reason))
        return false;
    umockdev_testbed_uevent(mock->testbed, sys_path, "add");
    return true;
}

static bool plug(fio_umockdev *mock, bool in) {
    bool done = true;
    if (!in) {
        mock->gone = true;
    } else {
        if (mock->gate >= 0)
            close(mock->gate);
        mock->gate = -1;
        name_node(mock, mock->number % 100 + 1);
    }
    mock->host.unlock(mock->host.context);
    if (in)
        done = put_back(mock);
    else
        take_away(mock);
    mock->host.lock(mock->host.context);
    return done;
}

static void close_mock(fio_umockdev *mock) {
    if (!mock->gone)
        umockdev_testbed_detach_ioctl(mock->testbed, mock->node, NULL);
    while (mock->urbs)
        release_urb(mock, mock->urbs);
    if (mock->gate >= 0)
        close(mock->gate);
    g_object_unref(mock->ioctls);
    g_object_unref(mock->testbed);
    g_free(mock);
}

static fio_umockdev *open_mock(const fio_umockdev_host *host, const fio_umockdev_device *device,
                               char reason[256]) {
    fio_umockdev *mock = g_new0(fio_umockdev, 1);
    mock->host = *host;
    mock->device = *device;
    mock->gate = -1;
    mock->gone = true;
    name_node(mock, 2);
    mock->testbed = umockdev_testbed_new();
    mock->ioctls = umockdev_ioctl_base_new();
    g_signal_connect(mock->ioctls, "handle-ioctl", G_CALLBACK(on_ioctl), mock);
    g_signal_connect(mock->ioctls, "client-vanished", G_CALLBACK(on_vanished), mock);
    if (add(mock, reason))
        return mock;
    close_mock(mock);
    return NULL;
}

static void bound(const fio_umockdev *mock, int *now, int *first) {
    fio_usb_claims_count(&mock->claims, now, first);
}

extern __attribute__((visibility("default"))) const fio_umockdev_module fio_umockdev_module_table;
const fio_umockdev_module fio_umockdev_module_table = {
    FIO_UMOCKDEV_VERSION, open_mock, gate, plug, bound, close_mock};
