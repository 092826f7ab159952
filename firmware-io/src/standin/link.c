#include "standin/link.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

void fio_link_begin(fio_link *link, int file, bool is_socket) {
    link->file = file;
    link->is_socket = is_socket;
    link->in_at = link->in_size = link->out_at = link->out_size = 0;
    link->full = link->no_more = link->held_back = false;
}

/* False if nothing more can be read for now. */
static bool take(fio_link *link, const fio_standin *standin) {
    size_t room = fio_machine_room(standin->machine);
    size_t most = room < sizeof link->in ? room : sizeof link->in;
    link->held_back = most == 0;
    if (most == 0)
        return false;
    ssize_t got = read(link->file, link->in, most);
    link->in_at = 0;
    link->in_size = got > 0 ? (size_t)got : 0;
    if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) /* EIO: a closed terminal */
        link->no_more = true;
    return got == (ssize_t)most;
}

static void hear(fio_link *link, fio_standin *standin, double now, bool readable) {
    readable |= link->held_back;
    while (readable || link->in_at < link->in_size) {
        if (link->in_at == link->in_size && !link->no_more)
            readable = take(link, standin);
        if (link->in_at == link->in_size)
            return;
        size_t taken = fio_machine_write(standin->machine, now, link->in + link->in_at,
                                         link->in_size - link->in_at);
        link->in_at += taken;
        standin->heard |= taken > 0;
        if (link->in_at < link->in_size)
            return;
    }
}

/* Without a signal if nobody listens any more. */
static ssize_t put_out(const fio_link *link, const uint8_t *bytes, size_t size) {
    if (link->no_more) {
        errno = EPIPE;
        return -1;
    }
    return link->is_socket ? send(link->file, bytes, size, MSG_NOSIGNAL)
                           : write(link->file, bytes, size);
}

static void tell(fio_link *link, fio_standin *standin, double now) {
    link->full = false;
    for (;;) {
        if (link->out_at == link->out_size) {
            link->out_at = 0;
            link->out_size = fio_machine_read(standin->machine, now, link->out, sizeof link->out);
        }
        if (link->out_at == link->out_size)
            return;
        ssize_t put = put_out(link, link->out + link->out_at, link->out_size - link->out_at);
        if (put < 0 && (errno == EAGAIN || errno == EINTR)) {
            link->full = true;
            return;
        }
        /* Nobody listens any more: as on a wire, that stops no printer. */
        link->out_at = put < 0 ? link->out_size : link->out_at + (size_t)put;
        standin->told |= put > 0;
    }
}

bool fio_link_serve(fio_link *link, fio_standin *standin, double now, bool readable) {
    hear(link, standin, now, readable);
    tell(link, standin, now);
    return !link->no_more || link->in_at < link->in_size;
}

short fio_link_events(const fio_link *link) {
    short events = 0;
    if (link->in_at == link->in_size && !link->no_more && !link->held_back)
        events |= POLLIN;
    if (link->full)
        events |= POLLOUT;
    return events;
}

double fio_link_next(const fio_link *link, const fio_standin *standin) {
    bool stuck = link->full && link->in_at == link->in_size && !link->held_back;
    return stuck ? INFINITY : fio_machine_next(standin->machine);
}
