#include "standin/usbip.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/memory.h"
#include "standin/listen.h"
#include "standin/usb_host.h"
#include "standin/usbip_wire.h"
#include "standin/vhci.h"

enum { CALLERS = 4, TRANSFERS_MOST = 1024 };

/* A URB of the far end; its data follow the struct. */
typedef struct transfer {
    fio_urb urb;
    uint32_t sequence;
    bool in;
    struct transfer *next; /* of all under way, newest first */
} transfer;

typedef struct message {
    uint8_t header[FIO_USBIP_HEADER];
    transfer *data; /* what it takes along and frees; NULL */
    struct message *next;
    size_t sent;
    size_t size; /* of the data */
} message;

typedef struct caller {
    int file; /* -1: none */
    uint8_t bytes[FIO_USBIP_HEADER];
    size_t held;
} caller;

typedef struct usbip {
    fio_standin standin;
    fio_virtual_usb *device;
    fio_usb_host host;
    int listener; /* -1: none */
    bool vhci;    /* plugged into our own kernel */
    caller callers[CALLERS];
    caller *importer;  /* one of them */
    transfer *filling; /* whose data are still coming */
    size_t filled;
    transfer *transfers;
    int transfer_count;
    message *messages, **messages_end;
    bool full;
} usbip;

static void hang_up(usbip *s, caller *who) {
    if (who->file >= 0)
        close(who->file);
    who->file = -1;
    who->held = 0;
}

static void forget_transfer(usbip *s, transfer *found) {
    for (transfer **at = &s->transfers; *at; at = &(*at)->next)
        if (*at == found) {
            *at = found->next;
            s->transfer_count--;
            return;
        }
}

/* The importer is gone: what was under way is, too. */
static void let_go(usbip *s) {
    if (!s->importer)
        return;
    hang_up(s, s->importer);
    s->importer = NULL;
    while (s->messages) {
        message *old = s->messages;
        s->messages = old->next;
        fio_release(old->data);
        fio_release(old);
    }
    s->messages_end = &s->messages;
    fio_release(s->filling);
    s->filling = NULL;
    while (s->transfers) {
        transfer *old = s->transfers;
        s->transfers = old->next;
        fio_release(old);
    }
    s->transfer_count = 0;
    s->full = false;
    s->standin.connected = false;
    fio_usb_host_begin(&s->host, s->device, s->standin.machine);
}

static bool send_message(usbip *s, fio_usbip_command command, uint32_t sequence, int status,
                         transfer *data) {
    message *sent = fio_allocate(sizeof *sent);
    if (!sent)
        return false;
    int moved = data ? data->urb.moved : 0;
    fio_usbip_write(sent->header, command, sequence, status, moved);
    sent->data = data;
    sent->size = data && data->in ? (size_t)moved : 0;
    *s->messages_end = sent;
    s->messages_end = &sent->next;
    return true;
}

/* False if it is out of memory. */
static bool answer_done(usbip *s) {
    for (fio_urb *urb; (urb = fio_usb_host_reap(&s->host, NULL));) {
        transfer *done = urb->owner;
        forget_transfer(s, done);
        bool unlinked = urb->status == -ECONNRESET;
        bool sent =
            !unlinked && send_message(s, FIO_USBIP_SUBMITTED, done->sequence, urb->status, done);
        if (!sent)
            fio_release(done);
        if (!sent && !unlinked)
            return false;
    }
    return true;
}

static bool submit(usbip *s, double now, transfer *of) {
    of->next = s->transfers;
    s->transfers = of;
    s->transfer_count++;
    s->standin.heard = true;
    fio_usb_host_submit(&s->host, now, &of->urb);
    return answer_done(s);
}

static bool unlink_it(usbip *s, const fio_usbip_header *header) {
    int status = 0; /* too late: it was answered before */
    for (transfer *at = s->transfers; at; at = at->next)
        if (at->sequence == header->unlink) {
            if (fio_usb_host_cancel(&s->host, &at->urb, -ECONNRESET))
                status = -ECONNRESET;
            break;
        }
    return send_message(s, FIO_USBIP_UNLINKED, header->sequence, status, NULL) && answer_done(s);
}

/* A whole header has come. False: nothing sensible can follow. */
static bool take_header(usbip *s, double now, const uint8_t *bytes) {
    fio_usbip_header header;
    if (!fio_usbip_read(&header, bytes))
        return false;
    if (header.command == FIO_USBIP_UNLINK)
        return unlink_it(s, &header);
    if (header.length < 0 || s->transfer_count >= TRANSFERS_MOST)
        return false;
    transfer *made = fio_allocate(sizeof *made + (size_t)header.length);
    if (!made)
        return false;
    made->sequence = header.sequence;
    made->in = header.in;
    made->urb = (fio_urb){.endpoint = header.endpoint,
                          .data = (uint8_t *)(made + 1),
                          .length = header.length,
                          .empty_packet = header.empty_packet,
                          .owner = made};
    memcpy(made->urb.setup, header.setup, sizeof header.setup);
    if (header.in || header.length == 0)
        return submit(s, now, made);
    s->filling = made;
    s->filled = 0;
    return true;
}

/* Read up to `wanted` bytes: 1 all of them are here, 0 not yet, -1 the far end is gone. */
static int fill(int file, uint8_t *bytes, size_t *held, size_t wanted) {
    while (*held < wanted) {
        ssize_t got = recv(file, bytes + *held, wanted - *held, 0);
        if (got < 0 && (errno == EAGAIN || errno == EINTR))
            return 0;
        if (got <= 0)
            return -1;
        *held += (size_t)got;
    }
    return 1;
}

static bool hear(usbip *s, double now) {
    for (;;) {
        caller *from = s->importer;
        int got;
        if (s->filling) {
            got =
                fill(from->file, s->filling->urb.data, &s->filled, (size_t)s->filling->urb.length);
            if (got <= 0)
                return got == 0;
            transfer *whole = s->filling;
            s->filling = NULL;
            if (!submit(s, now, whole))
                return false;
            continue;
        }
        got = fill(from->file, from->bytes, &from->held, sizeof from->bytes);
        if (got <= 0)
            return got == 0;
        from->held = 0;
        if (!take_header(s, now, from->bytes))
            return false;
    }
}

/* What is left of a message, header and data in one call: a kernel that has a header takes it that
 * the data are there as well. Until it has read them, Linux' vhci_hcd can't give the URB up, and
 * whoever unbinds its driver meanwhile spins with interrupts off (usb_hcd_flush_endpoint()): on a
 * machine of one processor we would never get to send the rest. */
static ssize_t send_rest(int file, message *of) {
    size_t header = of->sent < FIO_USBIP_HEADER ? FIO_USBIP_HEADER - of->sent : 0;
    size_t data = of->sent + header - FIO_USBIP_HEADER;
    struct iovec parts[2] = {{of->header + FIO_USBIP_HEADER - header, header}};
    if (of->size > data)
        parts[1] = (struct iovec){of->data->urb.data + data, of->size - data};
    return sendmsg(file, &(struct msghdr){.msg_iov = parts, .msg_iovlen = 2}, MSG_NOSIGNAL);
}

/* False if the far end is gone. */
static bool tell(usbip *s) {
    s->full = false;
    while (s->messages) {
        message *now = s->messages;
        ssize_t put = send_rest(s->importer->file, now);
        if (put < 0 && (errno == EAGAIN || errno == EINTR)) {
            s->full = true;
            return true;
        }
        if (put < 0)
            return false;
        now->sent += (size_t)put;
        s->standin.told = true;
        if (now->sent < FIO_USBIP_HEADER + now->size)
            continue;
        s->messages = now->next;
        if (!s->messages)
            s->messages_end = &s->messages;
        fio_release(now->data);
        fio_release(now);
    }
    return true;
}

static void import(usbip *s, caller *who) {
    who->held = 0;
    s->importer = who;
    s->standin.connected = true;
    s->standin.sessions++;
    fio_usb_host_begin(&s->host, s->device, s->standin.machine);
}

/* A request before any import. */
static void attend(usbip *s, caller *who) {
    int got = fill(who->file, who->bytes, &who->held, FIO_USBIP_REQUEST);
    size_t size = got == 1 ? fio_usbip_request_size(who->bytes) : 0;
    if (got == 1 && size > 0)
        got = fill(who->file, who->bytes, &who->held, size);
    if (got == 0)
        return;
    uint8_t reply[FIO_USBIP_REPLY_MOST];
    bool imported = false;
    if (got == 1 && size > 0) {
        bool free = !s->importer && fio_machine_plugged(s->standin.machine);
        size_t length = fio_usbip_answer(reply, s->device, who->bytes, free, &imported);
        imported &= send(who->file, reply, length, MSG_NOSIGNAL) == (ssize_t)length;
    }
    if (imported)
        import(s, who);
    else
        hang_up(s, who);
}

static void welcome(usbip *s) {
    for (int i = 0; i < CALLERS; i++)
        if (s->callers[i].file < 0) {
            s->callers[i] = (caller){.file = fio_listen_accept(s->listener)};
            return;
        }
}

static fio_status serve(fio_standin *standin, double now, const struct pollfd *polls, int count) {
    usbip *s = (usbip *)standin;
    bool alive = true;
    for (int i = 0; i < count; i++) {
        if (!polls[i].revents)
            continue;
        if (polls[i].fd == s->listener)
            welcome(s);
        for (int k = 0; k < CALLERS; k++)
            if (polls[i].fd == s->callers[k].file && polls[i].fd >= 0) {
                if (s->importer == &s->callers[k])
                    alive = hear(s, now);
                else
                    attend(s, &s->callers[k]);
            }
    }
    if (!s->importer)
        return FIO_OK;
    fio_usb_host_pump(&s->host, now);
    alive = alive && answer_done(s) && tell(s);
    if (!alive)
        let_go(s);
    return FIO_OK;
}

static int polls_of(fio_standin *standin, struct pollfd *polls, int most) {
    usbip *s = (usbip *)standin;
    int count = 0, callers = 0;
    for (int i = 0; i < CALLERS; i++)
        if (s->callers[i].file >= 0) {
            bool full = s->importer == &s->callers[i] && s->full;
            polls[count++] =
                (struct pollfd){s->callers[i].file, (short)(POLLIN | (full ? POLLOUT : 0)), 0};
            callers++;
        }
    if (s->listener >= 0 && callers < CALLERS)
        polls[count++] = (struct pollfd){s->listener, POLLIN, 0};
    return count;
}

static double next(const fio_standin *standin) {
    const usbip *s = (const usbip *)standin;
    return s->full       ? INFINITY
           : s->importer ? fio_usb_host_next(&s->host)
                         : fio_machine_next(standin->machine);
}

static fio_status plug_into_kernel(usbip *s) {
    caller *kernel = &s->callers[0];
    fio_status status = fio_vhci_attach(&kernel->file, fio_usbip_speed(s->device),
                                        FIO_USBIP_BUS << 16 | FIO_USBIP_NUMBER);
    if (status == FIO_OK)
        import(s, kernel);
    return status;
}

static fio_status plug(fio_standin *standin, bool in) {
    usbip *s = (usbip *)standin;
    if (!in)
        let_go(s); /* which the kernel at the other end takes for an unplugged device */
    else if (s->vhci)
        return plug_into_kernel(s);
    return FIO_OK;
}

static void close_it(fio_standin *standin) {
    usbip *s = (usbip *)standin;
    let_go(s);
    for (int i = 0; i < CALLERS; i++)
        hang_up(s, &s->callers[i]);
    if (s->listener >= 0)
        close(s->listener);
}

static usbip *create(fio_machine *machine, fio_pace *pace, fio_virtual_usb *device) {
    static const fio_standin_type type = {"usbip", polls_of, serve, next, plug, close_it};
    usbip *s = fio_allocate(sizeof *s);
    if (!s)
        return NULL;
    fio_standin_begin(&s->standin, &type, machine, pace);
    s->device = device;
    s->listener = -1;
    s->messages_end = &s->messages;
    for (int i = 0; i < CALLERS; i++)
        s->callers[i].file = -1;
    fio_usb_host_begin(&s->host, device, machine);
    return s;
}

static fio_status hand_over(fio_standin **standin, usbip *s, fio_status status) {
    if (status == FIO_OK)
        *standin = &s->standin;
    else
        fio_standin_close(&s->standin);
    return status;
}

fio_status fio_standin_usbip(fio_standin **standin, fio_machine *machine, fio_pace *pace,
                             fio_virtual_usb *device, const char *host, int port) {
    *standin = NULL;
    usbip *s = create(machine, pace, device);
    if (!s)
        return fio_fail(FIO_NO_MEMORY, "no memory for a USB/IP server");
    fio_status status = fio_listen_tcp(&s->listener, host, &port);
    snprintf(s->standin.where, sizeof s->standin.where, "usbip:%s:%d 1-1", host, port);
    return hand_over(standin, s, status);
}

fio_status fio_standin_usbip_socket(fio_standin **standin, fio_machine *machine, fio_pace *pace,
                                    fio_virtual_usb *device, int file) {
    *standin = NULL;
    usbip *s = create(machine, pace, device);
    if (!s) {
        close(file);
        return fio_fail(FIO_NO_MEMORY, "no memory for a USB/IP device");
    }
    s->callers[0].file = file;
    import(s, &s->callers[0]);
    snprintf(s->standin.where, sizeof s->standin.where, "usb:socket");
    *standin = &s->standin;
    return FIO_OK;
}

fio_status fio_standin_vhci(fio_standin **standin, fio_machine *machine, fio_pace *pace,
                            fio_virtual_usb *device) {
    *standin = NULL;
    usbip *s = create(machine, pace, device);
    if (!s)
        return fio_fail(FIO_NO_MEMORY, "no memory for a USB/IP device");
    s->vhci = true;
    snprintf(s->standin.where, sizeof s->standin.where, "usb:vhci_hcd");
    return hand_over(standin, s, plug_into_kernel(s));
}
