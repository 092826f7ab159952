#define _GNU_SOURCE /* ppoll() */
#include "standin/standin.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <string.h>
#include <time.h>

#include "base/memory.h"

enum {
    /* Jumps in a row without a byte from the host or an ok for it: enough for any heating, but what
     * only waits for a person must not talk without an end. */
    JUMPS_MOST = 2000
};

/* Shorter waits than a USB frame's half buy nothing. */
static const double shortest_wait = 0.0005, longest_wait = 3600;

void fio_standin_begin(fio_standin *standin, const fio_standin_type *type, fio_machine *machine,
                       fio_pace *pace) {
    standin->type = type;
    standin->machine = machine;
    standin->pace = pace;
    pthread_mutex_init(&standin->lock, NULL);
}

void fio_standin_close(fio_standin *standin) {
    if (!standin)
        return;
    standin->type->close(standin);
    pthread_mutex_destroy(&standin->lock);
    fio_release(standin);
}

static fio_status serve(fio_standin *standin, const struct pollfd *polls, int count) {
    double now = fio_pace_now(standin->pace);
    fio_machine_advance(standin->machine, now);
    fio_status status = standin->type->serve(standin, now, polls, count);
    int64_t oks = fio_machine_count(standin->machine)->oks;
    if (standin->heard || oks != standin->oks)
        standin->jumps = 0;
    standin->oks = oks;
    return status;
}

static bool may_jump(const fio_standin *standin) {
    return standin->pace->instant && standin->jumps < JUMPS_MOST &&
           fio_machine_plugged(standin->machine) && fio_machine_working(standin->machine);
}

fio_status fio_standin_turn(fio_standin *standin, const struct pollfd *polls, int count) {
    standin->heard = standin->told = false;
    fio_status status = serve(standin, polls, count);
    while (status == FIO_OK && !standin->heard && !standin->told && may_jump(standin)) {
        double next = standin->type->next(standin), event = fio_machine_next(standin->machine);
        if (event > next && event < INFINITY)
            next = event; /* not for each packet that only says that there is nothing */
        if (!(next < INFINITY) || next <= fio_pace_now(standin->pace))
            break;
        fio_pace_skip(standin->pace, next);
        standin->jumps++;
        status = serve(standin, NULL, 0);
    }
    return status;
}

static double monotonic(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + (double)time.tv_nsec * 1e-9;
}

static fio_status follow_plug(fio_standin *standin, const fio_standin_end *end, double time) {
    bool in = fio_machine_plugged(standin->machine);
    if (!in && standin->unplugged && end->replug_seconds >= 0 &&
        time >= standin->unplugged_at + end->replug_seconds) {
        fio_machine_plug(standin->machine, fio_pace_now(standin->pace));
        in = true;
    }
    if (in != standin->unplugged)
        return FIO_OK;
    standin->unplugged = !in;
    standin->unplugged_at = time;
    standin->plugs++;
    return standin->type->plug(standin, in);
}

static bool over(fio_standin *standin, const fio_standin_end *end, double time) {
    if (standin->heard)
        standin->heard_at = time;
    if (standin->connected || standin->sessions == 0)
        standin->left_at = time;
    bool working = fio_machine_working(standin->machine);
    if (end->once && standin->sessions > 0 && !standin->connected && !standin->unplugged &&
        (!working || time - standin->left_at > 1))
        return true;
    return end->idle_seconds > 0 && standin->heard_at > 0 && !working &&
           time - standin->heard_at >= end->idle_seconds;
}

/* How long nothing has to be done unless something happens outside. */
static double rest(const fio_standin *standin, const fio_standin_end *end, double time) {
    if (standin->heard || standin->told)
        return 0;
    double seconds = longest_wait;
    double next =
        standin->unplugged ? fio_machine_next(standin->machine) : standin->type->next(standin);
    if (next < INFINITY)
        seconds = fmin(seconds, fio_pace_until(standin->pace, next));
    if (standin->unplugged && end->replug_seconds >= 0)
        seconds = fmin(seconds, standin->unplugged_at + end->replug_seconds - time);
    if (end->idle_seconds > 0 && standin->heard_at > 0)
        seconds = fmin(seconds, standin->heard_at + end->idle_seconds - time);
    if (end->once && !standin->connected && standin->sessions > 0)
        seconds = fmin(seconds, 0.05);
    return fmax(seconds, shortest_wait);
}

fio_status fio_standin_run(fio_standin *standin, const fio_standin_end *end) {
    struct pollfd polls[FIO_STANDIN_POLLS];
    int count = 0;
    for (;;) {
        pthread_mutex_lock(&standin->lock);
        double time = monotonic();
        fio_status status = fio_standin_turn(standin, polls, count);
        if (status == FIO_OK)
            status = follow_plug(standin, end, time);
        count = status == FIO_OK ? standin->type->polls(standin, polls, FIO_STANDIN_POLLS) : 0;
        bool ended = status != FIO_OK || over(standin, end, time);
        double seconds = rest(standin, end, time);
        pthread_mutex_unlock(&standin->lock);
        if (ended || (end->stop && *end->stop))
            return status;
        struct timespec wait = {(time_t)seconds, (long)(fmod(seconds, 1) * 1e9)};
        if (ppoll(polls, (nfds_t)count, &wait, end->mask) < 0) {
            if (errno != EINTR)
                return fio_fail(FIO_BUG, "%s: can't wait: %s", standin->where, strerror(errno));
            for (int i = 0; i < count; i++)
                polls[i].revents = 0;
        }
    }
}
