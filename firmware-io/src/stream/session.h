/* Driving a streamer over a transport until it is done: the one loop there is. */
#ifndef FIO_STREAM_SESSION_H
#define FIO_STREAM_SESSION_H

#include <isoprint/transport.h>

#include "stream/streamer.h"

struct pollfd;

/* What else may wake the loop. All may be NULL. */
typedef struct fio_session_hooks {
    /* Fill in descriptors to watch (keys, signals, the source); returns their number. */
    int (*descriptors)(void *context, struct pollfd *polls, int most);
    /* After each wait, with the revents of those: make requests of the streamer here. */
    void (*woken)(void *context, double now, const struct pollfd *polls, int count);
    double period; /* s: woken() is called at least this often; 0: only when something happens */
    void *context;
} fio_session_hooks;

enum { FIO_SESSION_POLLS = 8 };

/* Returns the streamer's final status; its message is fio_error_message(). A lost transport is told
 * to the streamer, which ends. Neither is freed or closed. */
fio_status fio_session_run(fio_transport *transport, fio_streamer *streamer,
                           const fio_session_hooks *hooks) FIO_MUST_CHECK;

#endif
