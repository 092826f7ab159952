/* Ports by name, as isoprint opens them: on pseudo terminals, sockets and in memory. */
#define _GNU_SOURCE

#include "check.h"

#include <isoprint/port.h>

#include "base/memory.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[] = "/tmp/test-port-XXXXXX";

static bool says(const char *text) {
    return strstr(fio_error_message(), text) != NULL;
}

static void bad_names(void) {
    static const char *const names[] = {
        "",          "usb",      "usb:", "usb:2341", "usb:xyzw:0042",
        "tty:",      "socket:",  "tcp:", "tcp:host", "virtual:",
        "virtually", "/dev/tty", "AUTO", "auto ",    "tty"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        fio_transport *port = NULL;
        if (!CHECK_EQUAL(FIO_USAGE, fio_port_open(&port, names[i], NULL)))
            fprintf(stderr, "  \"%s\"\n", names[i]);
        CHECK(!port);
    }
    CHECK_EQUAL(FIO_USAGE, fio_port_wait("printer", 0));
    CHECK(says("\"printer\" is no port"));
}

static void absent_ports(void) {
    fio_transport *port = NULL;
    CHECK_EQUAL(FIO_NO_PRINTER, fio_port_open(&port, "usb:ffff:fffe", NULL));
    CHECK(says("usb:ffff:fffe: not there"));
    CHECK_EQUAL(FIO_NO_PRINTER, fio_port_open(&port, "tty:/dev/nothing-here", NULL));
    CHECK_EQUAL(FIO_NO_PRINTER, fio_port_open(&port, "socket:/nothing/here", NULL));
    CHECK_EQUAL(FIO_UNREADABLE, fio_port_open(&port, "virtual:/nothing/here", NULL));
    CHECK(says("/nothing/here"));
    CHECK_EQUAL(FIO_NO_PRINTER, fio_port_wait("usb:ffff:fffe", 0.05));
    CHECK(says("did not appear"));
    CHECK_EQUAL(FIO_NO_PRINTER, fio_port_wait("tty:/dev/nothing-here", 0.05));
    CHECK(!port);
}

static void listing(void) {
    fio_port *ports = NULL;
    int count = -1;
    CHECK_EQUAL(FIO_OK, fio_ports_list(&ports, &count));
    CHECK(count >= 0 && (count > 0) == (ports != NULL));
    for (int i = 0; i < count; i++) {
        CHECK(ports[i].name[0] && ports[i].driver[0] && ports[i].board[0]);
        CHECK(ports[i].allowed || ports[i].reason[0]);
        CHECK(i == 0 || ports[i - 1].certain >= ports[i].certain);
    }
    fio_ports_free(ports);
    fio_ports_free(NULL);
}

static void pseudo_terminal(void) {
    int master = posix_openpt(O_RDWR | O_NOCTTY);
    char name[80] = "tty:", text[8] = "";
    CHECK(grantpt(master) == 0 && unlockpt(master) == 0);
    CHECK(ptsname_r(master, name + 4, sizeof name - 4) == 0);
    fio_port_options options = fio_port_options_defaults();
    options.rate = 250000;
    fio_transport *port = NULL;
    CHECK_EQUAL(FIO_OK, fio_port_wait(name, 1));
    CHECK_EQUAL(FIO_OK, fio_port_open(&port, name, &options));
    size_t taken;
    CHECK_EQUAL(FIO_OK, fio_transport_write(port, "M105\n", 5, &taken));
    CHECK_EQUAL(5, read(master, text, sizeof text));
    CHECK(strcmp(port->type->name, "tty") == 0);
    fio_transport_close(port);
    close(master);
}

/* It comes while it is waited for. */
static void waiting_for_a_socket(void) {
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    char name[128];
    snprintf(address.sun_path, sizeof address.sun_path, "%s/late", folder);
    snprintf(name, sizeof name, "socket:%s", address.sun_path);
    int server = socket(AF_UNIX, SOCK_STREAM, 0);
    pid_t child = fork();
    if (child == 0) {
        usleep(100000);
        _exit(bind(server, (struct sockaddr *)&address, sizeof address) != 0 ||
              listen(server, 1) != 0);
    }
    CHECK_EQUAL(FIO_OK, fio_port_wait(name, 30));
    int result = 1;
    waitpid(child, &result, 0);
    CHECK_EQUAL(0, result);
    fio_transport *port = NULL;
    CHECK_EQUAL(FIO_OK, fio_port_open(&port, name, NULL));
    fio_transport_close(port);
    close(server);
    unlink(address.sun_path);
}

/* Send a line and read until an answer comes; the clock is virtual, so nothing is waited for. */
static bool answers(fio_transport *port, const char *line, const char *answer) {
    char text[4096] = "";
    size_t length = 0, at = 0, count;
    double end = fio_transport_now(port) + 60;
    while (!strstr(text, answer) && fio_transport_now(port) < end && length < sizeof text - 1) {
        if (!CHECK_EQUAL(FIO_OK, fio_transport_write(port, line + at, strlen(line + at), &count)))
            return false;
        at += count;
        if (!CHECK_EQUAL(FIO_OK, fio_transport_wait(port, line[at] != 0, NULL, 0, 1)) ||
            !CHECK_EQUAL(FIO_OK,
                         fio_transport_read(port, text + length, sizeof text - 1 - length, &count)))
            return false;
        length += count;
        text[length] = 0;
    }
    return strstr(text, answer) != NULL;
}

static void virtual_printer(void) {
    fio_port_options options = fio_port_options_defaults();
    options.virtual_options = "speed=0, boot_seconds=0.5 advanced_ok=1";
    fio_transport *port = NULL;
    CHECK_EQUAL(FIO_OK, fio_port_open(&port, "virtual", &options));
    CHECK(strcmp(port->type->name, "virtual") == 0);
    CHECK(answers(port, "", "start"));
    CHECK(answers(port, "M115\n", "FIRMWARE_NAME:Marlin"));
    CHECK(answers(port, "N1 G92 E0*70\n", "ok N1 P"));
    CHECK_EQUAL(0, fio_transport_pending(port));
    fio_transport_close(port);
}

static void virtual_options(void) {
    static const char *const bad[] = {"speed",
                                      "speed=",
                                      "speed=x",
                                      "colour=3",
                                      "speed=1x",
                                      "=1",
                                      "receive_bytes=-1",
                                      "flip_in=2",
                                      "firmware=a-name-that-is-much-too-long-for-it",
                                      "rate=1e3",
                                      "speed=-1"};
    fio_port_options options = fio_port_options_defaults();
    fio_transport *port = NULL;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        options.virtual_options = bad[i];
        if (!CHECK_EQUAL(FIO_USAGE, fio_port_open(&port, "virtual", &options)))
            fprintf(stderr, "  \"%s\"\n", bad[i]);
        CHECK(!port);
    }
}

static void virtual_script(void) {
    char path[64], name[80];
    snprintf(path, sizeof path, "%s/script", folder);
    snprintf(name, sizeof name, "virtual:%s", path);
    FILE *file = fopen(path, "w");
    fputs("at line 2 unplug\n", file);
    fclose(file);
    fio_port_options options = fio_port_options_defaults();
    options.virtual_options = "speed=0";
    fio_transport *port = NULL;
    CHECK_EQUAL(FIO_OK, fio_port_open(&port, name, &options));
    fio_status status = FIO_OK;
    size_t count;
    char bytes[256];
    for (int i = 0; i < 1000 && status == FIO_OK; i++) {
        status = fio_transport_write(port, "M105\n", 5, &count);
        if (status == FIO_OK)
            status = fio_transport_wait(port, false, NULL, 0, 1);
        if (status == FIO_OK)
            status = fio_transport_read(port, bytes, sizeof bytes, &count);
    }
    CHECK_EQUAL(FIO_LINK_LOST, status);
    fio_transport_close(port);
    file = fopen(path, "w");
    fputs("at noon sing\n", file);
    fclose(file);
    CHECK_EQUAL(FIO_USAGE, fio_port_open(&port, name, &options));
    CHECK(says("line 1"));
    unlink(path);
}

/* Each allocation fails once: a status, no port, no leak. */
static void no_memory(void) {
    fio_port_options options = fio_port_options_defaults();
    fio_transport *port = NULL;
    fio_status status = FIO_NO_MEMORY;
    int n = 0;
    for (; status != FIO_OK && n < 100; n++) {
        fio_fail_allocation_after(n);
        status = fio_port_open(&port, "virtual", &options);
        fio_fail_allocation_after(-1);
        CHECK(status == FIO_OK || (status == FIO_NO_MEMORY && !port));
    }
    CHECK(n > 2 && status == FIO_OK);
    fio_transport_close(port);
    fio_port *ports = NULL;
    int count;
    fio_fail_allocation_after(0);
    CHECK_EQUAL(FIO_NO_MEMORY, fio_ports_list(&ports, &count));
    CHECK_EQUAL(FIO_NO_MEMORY, fio_port_open(&port, "auto", NULL));
    CHECK_EQUAL(FIO_NO_MEMORY, fio_port_wait("auto", 0));
    fio_fail_allocation_after(-1);
    CHECK(!ports && !port);
}

int main(void) {
    if (!mkdtemp(folder))
        return 1;
    RUN(bad_names);
    RUN(absent_ports);
    RUN(listing);
    RUN(pseudo_terminal);
    RUN(waiting_for_a_socket);
    RUN(virtual_printer);
    RUN(virtual_options);
    RUN(virtual_script);
    RUN(no_memory);
    rmdir(folder);
    return check_verdict();
}
