#include "fake_libusb.h"

#include <stdlib.h>
#include <string.h>

fake_libusb fake;

void fake_begin(void) {
    fake = (fake_libusb){0};
}

static int find(unsigned char endpoint, int n) {
    for (int i = 0; i < fake.count; i++)
        if (fake.flying[i]->endpoint == endpoint && n-- == 0)
            return i;
    return -1;
}

static void end_at(int i, enum libusb_transfer_status status, int size) {
    struct libusb_transfer *transfer = fake.flying[i];
    fake.count--;
    for (; i < fake.count; i++) {
        fake.flying[i] = fake.flying[i + 1];
        fake.cancelled[i] = fake.cancelled[i + 1];
    }
    transfer->status = status;
    transfer->actual_length = size;
    transfer->callback(transfer);
}

bool fake_end(unsigned char endpoint, int n, enum libusb_transfer_status status, int size,
              const void *bytes) {
    int i = find(endpoint, n);
    if (i < 0 || size > fake.flying[i]->length)
        return false;
    if (endpoint & LIBUSB_ENDPOINT_IN && bytes)
        memcpy(fake.flying[i]->buffer, bytes, (size_t)size);
    else if (endpoint & LIBUSB_ENDPOINT_IN)
        memset(fake.flying[i]->buffer, 0, (size_t)size);
    end_at(i, status, size);
    return true;
}

struct libusb_transfer *fake_flying(unsigned char endpoint, int n) {
    int i = find(endpoint, n);
    return i < 0 ? NULL : fake.flying[i];
}

int fake_count(unsigned char endpoint) {
    int count = 0;
    while (find(endpoint, count) >= 0)
        count++;
    return count;
}

struct libusb_transfer *LIBUSB_CALL libusb_alloc_transfer(int packets) {
    return calloc(1, sizeof(struct libusb_transfer));
}

void LIBUSB_CALL libusb_free_transfer(struct libusb_transfer *transfer) {
    free(transfer);
}

int LIBUSB_CALL libusb_submit_transfer(struct libusb_transfer *transfer) {
    if (fake.refuse)
        return fake.refuse;
    if (fake.count == FAKE_FLYING)
        return LIBUSB_ERROR_NO_MEM;
    for (int i = 0; i < fake.count; i++)
        if (fake.flying[i] == transfer)
            return LIBUSB_ERROR_BUSY; /* what libusb says of one that is still under way */
    fake.cancelled[fake.count] = false;
    fake.flying[fake.count++] = transfer;
    fake.submitted++;
    return 0;
}

int LIBUSB_CALL libusb_cancel_transfer(struct libusb_transfer *transfer) {
    for (int i = 0; i < fake.count; i++)
        if (fake.flying[i] == transfer) {
            fake.cancelled[i] = true;
            return 0;
        }
    return LIBUSB_ERROR_NOT_FOUND;
}

int LIBUSB_CALL libusb_clear_halt(libusb_device_handle *handle, unsigned char endpoint) {
    fake.halts_cleared++;
    fake.halt_cleared = endpoint;
    return find(endpoint, 0) >= 0 ? LIBUSB_ERROR_BUSY : 0;
}

const char *LIBUSB_CALL libusb_strerror(int error) {
    return error == LIBUSB_ERROR_NO_DEVICE ? "no such device" : "other error";
}

/* What was cancelled ends, as in libusb, while events are handled. */
int LIBUSB_CALL libusb_handle_events_timeout_completed(libusb_context *context,
                                                       struct timeval *limit, int *completed) {
    for (int i = 0; !fake.deaf && i < fake.count;)
        if (fake.cancelled[i])
            end_at(i, LIBUSB_TRANSFER_CANCELLED, 0), i = 0;
        else
            i++;
    return 0;
}

int LIBUSB_CALL libusb_get_next_timeout(libusb_context *context, struct timeval *limit) {
    return 0;
}

int LIBUSB_CALL libusb_init(libusb_context **context) {
    *context = NULL;
    return LIBUSB_ERROR_OTHER;
}

void LIBUSB_CALL libusb_exit(libusb_context *context) {}

const struct libusb_pollfd **LIBUSB_CALL libusb_get_pollfds(libusb_context *context) {
    return NULL;
}

void LIBUSB_CALL libusb_free_pollfds(const struct libusb_pollfd **list) {}

void LIBUSB_CALL libusb_set_pollfd_notifiers(libusb_context *context, libusb_pollfd_added_cb added,
                                             libusb_pollfd_removed_cb removed, void *user) {}

int LIBUSB_CALL libusb_pollfds_handle_timeouts(libusb_context *context) {
    return 0;
}
