#include "standin/standin.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/memory.h"
#include "standin/link.h"
#include "standin/listen.h"

typedef struct server {
    fio_standin standin;
    fio_link link;
    int listener;
    char path[108]; /* of a Unix socket; "" */
} server;

static void hang_up(server *s, double now) {
    if (s->link.file < 0)
        return;
    close(s->link.file);
    s->link.file = -1;
    s->standin.connected = false;
    fio_machine_set_lines(s->standin.machine, now, false, false);
}

static void welcome(server *s, double now) {
    int file = fio_listen_accept(s->listener);
    if (file < 0)
        return;
    fio_link_begin(&s->link, file, true);
    s->standin.connected = true;
    s->standin.sessions++;
    fio_machine_set_lines(s->standin.machine, now, true, true);
}

static void forget(server *s, double now) {
    char bytes[512];
    while (fio_machine_read(s->standin.machine, now, bytes, sizeof bytes) > 0)
        continue;
}

static fio_status serve(fio_standin *standin, double now, const struct pollfd *polls, int count) {
    server *s = (server *)standin;
    bool readable = false;
    for (int i = 0; i < count; i++)
        if (!polls[i].revents)
            continue;
        else if (polls[i].fd == s->listener)
            welcome(s, now);
        else
            readable = (polls[i].revents & (POLLIN | POLLHUP | POLLERR)) != 0;
    if (!standin->connected)
        forget(s, now);
    else if (!fio_link_serve(&s->link, standin, now, readable))
        hang_up(s, now);
    return FIO_OK;
}

static int polls_of(fio_standin *standin, struct pollfd *polls, int most) {
    server *s = (server *)standin;
    if (standin->connected && fio_link_events(&s->link) == 0)
        return 0;
    if (standin->connected)
        polls[0] = (struct pollfd){s->link.file, fio_link_events(&s->link), 0};
    else if (!standin->unplugged)
        polls[0] = (struct pollfd){s->listener, POLLIN, 0};
    else
        return 0; /* who calls now waits until the cable is back */
    return 1;
}

static double next(const fio_standin *standin) {
    const server *s = (const server *)standin;
    return standin->connected ? fio_link_next(&s->link, standin)
                              : fio_machine_next(standin->machine);
}

static fio_status plug(fio_standin *standin, bool in) {
    if (!in)
        hang_up((server *)standin, fio_pace_now(standin->pace));
    return FIO_OK;
}

static void close_it(fio_standin *standin) {
    server *s = (server *)standin;
    hang_up(s, fio_pace_now(standin->pace));
    if (s->listener >= 0)
        close(s->listener);
    if (s->listener >= 0 && s->path[0])
        unlink(s->path);
}

static fio_status create(server **s, fio_machine *machine, fio_pace *pace) {
    static const fio_standin_type type = {"socket", polls_of, serve, next, plug, close_it};
    *s = fio_allocate(sizeof **s);
    if (!*s)
        return fio_fail(FIO_NO_MEMORY, "no memory for a socket");
    fio_standin_begin(&(*s)->standin, &type, machine, pace);
    (*s)->link.file = (*s)->listener = -1;
    return FIO_OK;
}

static fio_status hand_over(fio_standin **standin, server *s, fio_status status) {
    if (status == FIO_OK)
        *standin = &s->standin;
    else
        fio_standin_close(&s->standin);
    return status;
}

fio_status fio_standin_socket(fio_standin **standin, fio_machine *machine, fio_pace *pace,
                              const char *path) {
    server *s;
    *standin = NULL;
    fio_status status = create(&s, machine, pace);
    if (status != FIO_OK)
        return status;
    status = fio_listen_path(&s->listener, path);
    if (status == FIO_OK) {
        snprintf(s->path, sizeof s->path, "%s", path);
        snprintf(s->standin.where, sizeof s->standin.where, "socket:%s", path);
    }
    return hand_over(standin, s, status);
}

fio_status fio_standin_tcp(fio_standin **standin, fio_machine *machine, fio_pace *pace,
                           const char *host, int port) {
    server *s;
    *standin = NULL;
    fio_status status = create(&s, machine, pace);
    if (status != FIO_OK)
        return status;
    status = fio_listen_tcp(&s->listener, host, &port);
    snprintf(s->standin.where, sizeof s->standin.where, "tcp:%s:%d", host, port);
    return hand_over(standin, s, status);
}
