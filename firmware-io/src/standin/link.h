/* A descriptor that a host has at its other end, and what of its bytes is under way. */
#ifndef FIO_STANDIN_LINK_H
#define FIO_STANDIN_LINK_H

#include "standin/standin.h"

typedef struct fio_link {
    int file; /* -1: nobody is there */
    bool is_socket;
    size_t in_at, in_size, out_at, out_size;
    bool held_back; /* the machine has no room: what is not read has not left the host */
    bool full;      /* the host takes no more */
    bool no_more;   /* the host has closed its side; what it sent before is still passed on */
    uint8_t in[1024], out[4096];
} fio_link;

void fio_link_begin(fio_link *link, int file, bool is_socket);

/* Move bytes both ways between the descriptor and the machine. `readable`: there may be something
 * to read. False once the host is gone and all it sent has been passed on. */
bool fio_link_serve(fio_link *link, fio_standin *standin, double now, bool readable);

/* POLLIN, POLLOUT as it can go on. */
short fio_link_events(const fio_link *link);
double fio_link_next(const fio_link *link, const fio_standin *standin);

#endif
