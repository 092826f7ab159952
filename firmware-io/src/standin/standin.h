/* Something that the virtual printer stands at the far end of: a pseudo terminal, a socket, a USB
 * device of umockdev or of USB/IP. One loop drives them all. */
#ifndef FIO_STANDIN_STANDIN_H
#define FIO_STANDIN_STANDIN_H

#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <isoprint/machine.h>

#include "standin/pace.h"

struct pollfd;

typedef struct fio_standin fio_standin;

/* Called by the loop, with the lock held; none of them waits. */
typedef struct fio_standin_type {
    const char *name;
    /* What to watch; returns the number of `polls`. */
    int (*polls)(fio_standin *standin, struct pollfd *polls, int most);
    /* Move bytes both ways, as far as they go by `now`. `polls` are those given before, with what
     * happened to them; count 0: nothing was looked at. */
    fio_status (*serve)(fio_standin *standin, double now, const struct pollfd *polls, int count);
    /* When serve() is worth calling next although nothing happens outside, on the machine's clock;
     * INFINITY. */
    double (*next)(const fio_standin *standin);
    /* The cable was pulled or put back, by the script. */
    fio_status (*plug)(fio_standin *standin, bool in);
    /* Let go of everything but the struct itself. */
    void (*close)(fio_standin *standin);
} fio_standin_type;

/* Comes first in every stand-in. */
struct fio_standin {
    const fio_standin_type *type;
    fio_machine *machine; /* the caller's */
    fio_pace *pace;       /* the caller's */
    pthread_mutex_t lock; /* of the machine, the pace and the stand-in */
    bool connected;       /* a host is there */
    bool heard, told;     /* set by serve(): bytes came from the host, went to it */
    int64_t sessions;     /* hosts that came */
    int64_t plugs;        /* times the plug was pulled or put back */
    char where[256];      /* what a host has to open */

    /* The loop's own. */
    bool unplugged;
    int jumps; /* of the pace since something came from the host or was done for it */
    int64_t oks;
    double unplugged_at, heard_at, left_at; /* seconds of our clock */
};

enum { FIO_STANDIN_POLLS = 16 };

void fio_standin_begin(fio_standin *standin, const fio_standin_type *type, fio_machine *machine,
                       fio_pace *pace);
void fio_standin_close(fio_standin *standin); /* NULL is fine */

/* Serve, and while the pace is instant and the printer works at something, jump to its next event
 * until that is one for the host. For the loop, and for stand-ins with a thread of their own. */
fio_status fio_standin_turn(fio_standin *standin, const struct pollfd *polls, int count);

/* When the loop is to end; all may be 0 or NULL. */
typedef struct fio_standin_end {
    const volatile sig_atomic_t *stop; /* becomes true in a signal's handler */
    const sigset_t *mask;              /* of signals while it waits: those that set `stop` */
    bool once;                         /* after the first host has gone and its lines are done */
    double idle_seconds;   /* after so long without a byte from the host, once it has sent some */
    double replug_seconds; /* put the cable back so long after it was pulled; < 0: never */
} fio_standin_end;

/* Drive it until the end. FIO_OK also when a signal ended it. */
fio_status fio_standin_run(fio_standin *standin, const fio_standin_end *end) FIO_MUST_CHECK;

/* A pseudo terminal whose name is in `where`; `link`: a symbolic link to make to it, NULL. */
fio_status fio_standin_pty(fio_standin **standin, fio_machine *machine, fio_pace *pace,
                           const char *link) FIO_MUST_CHECK;

/* Servers that take one host at a time, and then the next. A `path` that is a socket left over from
 * before is replaced, anything else there is not. `port` 0: any free one. */
fio_status fio_standin_socket(fio_standin **standin, fio_machine *machine, fio_pace *pace,
                              const char *path) FIO_MUST_CHECK;
fio_status fio_standin_tcp(fio_standin **standin, fio_machine *machine, fio_pace *pace,
                           const char *host, int port) FIO_MUST_CHECK;

#endif
