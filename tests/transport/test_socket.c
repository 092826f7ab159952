/* Sockets: paths and ports, with a plain server at the other end. */
#define _GNU_SOURCE

#include "check.h"

#include <isoprint/transport.h>

#include "transport/socket.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

static char folder[] = "/tmp/test-socket-XXXXXX";
static char path[64];

static int listen_path(int backlog) {
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    snprintf(address.sun_path, sizeof address.sun_path, "%s", path);
    int server = socket(AF_UNIX, SOCK_STREAM, 0);
    unlink(path);
    CHECK(bind(server, (struct sockaddr *)&address, sizeof address) == 0);
    CHECK(listen(server, backlog) == 0);
    return server;
}

static int listen_port(int *port) {
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t size = sizeof address;
    int server = socket(AF_INET, SOCK_STREAM, 0);
    CHECK(bind(server, (struct sockaddr *)&address, sizeof address) == 0);
    CHECK(listen(server, 4) == 0);
    CHECK(getsockname(server, (struct sockaddr *)&address, &size) == 0);
    *port = ntohs(address.sin_port);
    return server;
}

static void read_until(fio_transport *port, const char *expected) {
    char text[64] = "";
    size_t total = 0, count, wanted = strlen(expected);
    for (double end = fio_transport_now(port) + 10;
         total < wanted && fio_transport_now(port) < end;) {
        CHECK_EQUAL(FIO_OK, fio_transport_wait(port, false, NULL, 0, 1));
        CHECK_EQUAL(FIO_OK,
                    fio_transport_read(port, text + total, sizeof text - 1 - total, &count));
        total += count;
    }
    CHECK(strcmp(text, expected) == 0);
}

static void dialogue(fio_transport *port, int peer) {
    size_t count;
    char text[16] = "";
    CHECK_EQUAL(FIO_OK, fio_transport_write(port, "M105\n", 5, &count));
    CHECK_EQUAL(5, count);
    CHECK_EQUAL(5, recv(peer, text, 5, MSG_WAITALL));
    CHECK(strcmp(text, "M105\n") == 0);
    CHECK_EQUAL(5, send(peer, "ok T:", 5, 0));
    CHECK_EQUAL(4, send(peer, "20\n\xff", 4, 0));
    read_until(port, "ok T:20\n\xff");
    CHECK(!port->type->set_rate && !port->type->set_lines);
}

static void over_a_path(void) {
    int server = listen_path(1);
    fio_transport *port = NULL;
    CHECK_EQUAL(FIO_OK, fio_socket_open_path(&port, path, 2));
    int peer = accept(server, NULL, NULL);
    dialogue(port, peer);
    fio_transport_close(port);
    char byte;
    CHECK_EQUAL(0, read(peer, &byte, 1)); /* closed */
    close(peer);
    close(server);
}

static void over_tcp(void) {
    int number;
    int server = listen_port(&number);
    char address[64];
    snprintf(address, sizeof address, "127.0.0.1:%d", number);
    fio_transport *port = NULL;
    CHECK_EQUAL(FIO_OK, fio_socket_open_host(&port, address, 2));
    int peer = accept(server, NULL, NULL);
    dialogue(port, peer);
    fio_transport_close(port);
    close(peer);
    close(server);
    CHECK_EQUAL(FIO_NO_PRINTER, fio_socket_open_host(&port, address, 2));
    CHECK(strstr(fio_error_message(), "nobody listens") != NULL);
}

/* A peer that reads nothing holds us back after little, by waiting, and then gets every byte. */
static void back_pressure_of(fio_transport *port, int peer) {
    size_t sent = 0, count, waits = 0;
    static unsigned char got[1 << 22];
    for (double end = fio_transport_now(port) + 1; fio_transport_now(port) < end && waits < 20;) {
        unsigned char bytes[300];
        for (size_t i = 0; i < sizeof bytes; i++)
            bytes[i] = (unsigned char)((sent + i) % 251);
        CHECK_EQUAL(FIO_OK, fio_transport_write(port, bytes, sizeof bytes, &count));
        sent += count;
        if (count == 0) {
            waits++;
            CHECK_EQUAL(FIO_OK, fio_transport_wait(port, true, NULL, 0, 0.01));
        }
        if (sent > sizeof got - 1000)
            break;
    }
    CHECK(fio_transport_pending(port) <= 512);
    size_t total = 0, wrong = 0;
    while (total < sent) {
        ssize_t n = recv(peer, got + total, sizeof got - total, 0);
        if (!CHECK(n > 0))
            break;
        total += (size_t)n;
    }
    for (size_t i = 0; i < total; i++)
        wrong += got[i] != i % 251;
    CHECK_EQUAL(sent, total);
    CHECK_EQUAL(0, wrong);
    for (double end = fio_transport_now(port) + 10;
         fio_transport_pending(port) > 0 && fio_transport_now(port) < end;)
        CHECK_EQUAL(FIO_OK, fio_transport_wait(port, false, NULL, 0, 0.002));
    CHECK_EQUAL(0, fio_transport_pending(port));
    CHECK_EQUAL(FIO_OK, fio_transport_write(port, "x", 1, &count));
    CHECK_EQUAL(1, count);
}

static void back_pressure(void) {
    int server = listen_path(1);
    fio_transport *port = NULL;
    CHECK_EQUAL(FIO_OK, fio_socket_open_path(&port, path, 2));
    int peer = accept(server, NULL, NULL);
    back_pressure_of(port, peer);
    fio_transport_close(port);
    close(peer);
    close(server);
}

/* Through a unix socket at most 512 bytes wait for a peer that does not read; all that is pending
 * will arrive, so a discard keeps it. */
static void little_is_held(void) {
    int server = listen_path(1);
    fio_transport *port = NULL;
    CHECK_EQUAL(FIO_OK, fio_socket_open_path(&port, path, 2));
    int peer = accept(server, NULL, NULL);
    size_t sent = 0, count = 1, kept;
    char bytes[100] = "", got[1000];
    while (count && sent < 100000) {
        CHECK_EQUAL(FIO_OK, fio_transport_write(port, bytes, sizeof bytes, &count));
        sent += count;
    }
    CHECK_EQUAL(512, sent);
    CHECK_EQUAL(512, fio_transport_pending(port));
    CHECK_EQUAL(FIO_OK, fio_transport_discard(port, &kept));
    CHECK_EQUAL(512, kept);
    CHECK_EQUAL(512, recv(peer, got, sizeof got, MSG_DONTWAIT));
    fio_transport_close(port);
    close(peer);
    close(server);
}

static void end_is_a_loss(void) {
    int server = listen_path(1);
    fio_transport *port = NULL;
    CHECK_EQUAL(FIO_OK, fio_socket_open_path(&port, path, 2));
    int peer = accept(server, NULL, NULL);
    CHECK_EQUAL(3, send(peer, "ok\n", 3, 0));
    close(peer);
    char bytes[8];
    size_t count;
    /* Writing to it fails first, without a signal; what it said is still read. */
    CHECK_EQUAL(FIO_LINK_LOST, fio_transport_write(port, "M105\n", 5, &count));
    CHECK_EQUAL(FIO_OK, fio_transport_read(port, bytes, sizeof bytes, &count));
    CHECK_EQUAL(3, count);
    CHECK_EQUAL(FIO_LINK_LOST, fio_transport_read(port, bytes, sizeof bytes, &count));
    CHECK(strstr(fio_error_message(), path) != NULL);
    CHECK_EQUAL(FIO_LINK_LOST, fio_transport_wait(port, false, NULL, 0, 10));
    CHECK_EQUAL(FIO_LINK_LOST, fio_transport_discard(port, &count));
    fio_transport_close(port);
    close(server);
}

/* A listener whose queue is full never answers: connecting ends in time all the same. */
static void connecting_is_limited(void) {
    int server = listen_path(0);
    fio_transport *ports[16] = {0};
    int made = 0;
    fio_status status = FIO_OK;
    while (status == FIO_OK && made < 15) {
        status = fio_socket_open_path(&ports[made], path, 0.1);
        made += status == FIO_OK;
    }
    CHECK_EQUAL(FIO_NO_PRINTER, status);
    CHECK(made >= 1);
    for (int i = 0; i < made; i++)
        fio_transport_close(ports[i]);
    close(server);
}

static void addresses(void) {
    fio_transport *port = NULL;
    const char *bad[] = {"",          "localhost",        ":80",   "localhost:", "localhost:x",
                         "a:b:80",    "localhost:123456", "[]:80", "host:-1",    "::1:80",
                         "host:80:90"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        if (!CHECK_EQUAL(FIO_USAGE, fio_socket_open_host(&port, bad[i], 1)))
            fprintf(stderr, "  for \"%s\"\n", bad[i]);
    char longest[400];
    memset(longest, 'x', sizeof longest);
    longest[sizeof longest - 1] = 0;
    CHECK_EQUAL(FIO_USAGE, fio_socket_open_path(&port, longest, 1));
    CHECK_EQUAL(FIO_NO_PRINTER, fio_socket_open_path(&port, "/nonexistent/socket", 1));
    CHECK(strstr(fio_error_message(), "nobody listens") != NULL);
    CHECK(!port);
}

int main(void) {
    if (!mkdtemp(folder))
        return 1;
    snprintf(path, sizeof path, "%s/s", folder);
    RUN(over_a_path);
    RUN(over_tcp);
    RUN(back_pressure);
    RUN(little_is_held);
    RUN(end_is_a_loss);
    RUN(connecting_is_limited);
    RUN(addresses);
    unlink(path);
    rmdir(folder);
    return check_verdict();
}
