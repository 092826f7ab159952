/* The printer at the far end of a pseudo terminal and of sockets, as a host sees it. */
#include "rig.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <termios.h>

#include "transport/tty.h"

static char folder[] = "/tmp/isoprint-ends-XXXXXX";

static void path_in(char path[64], const char *name) {
    snprintf(path, 64, "%s/%s", folder, name);
}

static bool says(int file, const char *text) {
    return write(file, text, strlen(text)) == (ssize_t)strlen(text);
}

/* The link itself, wherever it leads. */
static bool is_there(const char *path) {
    struct stat found;
    return lstat(path, &found) == 0;
}

static int open_terminal(const char *path) {
    return open(path, O_RDWR | O_NOCTTY | O_NONBLOCK);
}

static void test_pty_answers_each_host_anew(void) {
    char path[64];
    path_in(path, "printer");
    fio_machine *machine = rig_machine(true);
    fio_pace pace = fio_pace_start(0);
    fio_standin *pty = NULL;
    CHECK_EQUAL(FIO_OK, fio_standin_pty(&pty, machine, &pace, path));
    rig_turn(pty);
    CHECK(!pty->connected);
    for (int i = 1; i <= 3; i++) {
        int host = open_terminal(path);
        CHECK(host >= 0);
        CHECK(rig_reads(pty, host, "start")); /* opening raises DTR, which resets the board */
        CHECK(pty->connected);
        CHECK_EQUAL(i, pty->sessions);
        CHECK_EQUAL(i, fio_machine_count(machine)->resets);
        CHECK(says(host, "M115\n"));
        CHECK(rig_reads(pty, host, "FIRMWARE_NAME:"));
        CHECK(says(host, "G92 X1\nM114\n")); /* not read: the next host must not see the answers */
        rig_turn(pty);
        close(host);
        rig_turn(pty);
        CHECK(!pty->connected);
    }
    CHECK_EQUAL(9, rig_lines(machine));
    fio_standin_close(pty);
    CHECK(!is_there(path));
    fio_machine_free(machine);
}

static void test_pty_is_raw_and_made_raw_again(void) {
    fio_machine *machine = rig_machine(false);
    fio_pace pace = fio_pace_start(0);
    fio_standin *pty = NULL;
    struct termios modes;
    CHECK_EQUAL(FIO_OK, fio_standin_pty(&pty, machine, &pace, NULL));
    const char *name = pty->where + strlen("tty:");
    for (int i = 0; i < 2; i++) {
        int host = open_terminal(name);
        rig_turn(pty);
        CHECK_EQUAL(0, tcgetattr(host, &modes));
        CHECK_EQUAL(0, modes.c_lflag & (ICANON | ECHO | ISIG));
        CHECK_EQUAL(0, modes.c_oflag & OPOST);
        modes.c_lflag |= ICANON | ECHO;
        CHECK_EQUAL(0, tcsetattr(host, TCSANOW, &modes));
        close(host);
        rig_turn(pty);
    }
    fio_standin_close(pty);
    fio_machine_free(machine);
}

static void test_pty_without_a_host_costs_nothing(void) {
    fio_machine *machine = rig_machine(false);
    fio_pace pace = fio_pace_start(1);
    fio_standin *pty = NULL;
    struct pollfd polls[FIO_STANDIN_POLLS];
    CHECK_EQUAL(FIO_OK, fio_standin_pty(&pty, machine, &pace, NULL));
    rig_turn(pty);
    int count = pty->type->polls(pty, polls, FIO_STANDIN_POLLS);
    CHECK_EQUAL(0, poll(polls, (nfds_t)count, 20)); /* a hang-up that is reported would spin */
    int host = open_terminal(pty->where + strlen("tty:"));
    CHECK_EQUAL(1, poll(polls, (nfds_t)count, 1000));
    close(host);
    fio_standin_close(pty);
    fio_machine_free(machine);
}

static void test_bytes_at_a_wrong_rate_are_rubbish(void) {
    fio_machine_options options = fio_machine_options_defaults();
    fio_machine *machine = NULL;
    fio_pace pace = fio_pace_start(0);
    fio_standin *pty = NULL;
    struct termios modes;
    options.rate = 115200;
    options.boot_seconds = 0;
    CHECK_EQUAL(FIO_OK, fio_machine_create(&machine, &options));
    CHECK_EQUAL(FIO_OK, fio_standin_pty(&pty, machine, &pace, NULL));
    int host = open_terminal(pty->where + strlen("tty:"));
    tcgetattr(host, &modes);
    cfsetispeed(&modes, B9600), cfsetospeed(&modes, B9600);
    tcsetattr(host, TCSANOW, &modes);
    rig_turn(pty);
    CHECK(says(host, "M115\n"));
    for (int i = 0; i < 5; i++)
        rig_turn(pty);
    char bytes[4096];
    ssize_t got = read(host, bytes, sizeof bytes - 1);
    bytes[got > 0 ? got : 0] = 0;
    CHECK(!strstr(bytes, "FIRMWARE_NAME"));
    cfsetispeed(&modes, B115200), cfsetospeed(&modes, B115200);
    tcsetattr(host, TCSANOW, &modes);
    CHECK(says(host, "\nM115\n"));
    CHECK(rig_reads(pty, host, "FIRMWARE_NAME"));
    close(host);
    fio_standin_close(pty);
    fio_machine_free(machine);
}

/* As hosts do that set any rate: BOTHER and a number, here after a rate that has a name. */
static void test_rates_set_by_their_number_count(void) {
    fio_machine_options options = fio_machine_options_defaults();
    fio_machine *machine = NULL;
    fio_pace pace = fio_pace_start(0);
    fio_standin *pty = NULL;
    const char *bytes = "\nM115\n";
    options.rate = 250000;
    options.boot_seconds = 0;
    CHECK_EQUAL(FIO_OK, fio_machine_create(&machine, &options));
    CHECK_EQUAL(FIO_OK, fio_standin_pty(&pty, machine, &pace, NULL));
    const char *name = pty->where + strlen("tty:");
    int early = open_terminal(name); /* keeps it open: a host that has not set its rate yet */
    rig_turn(pty);
    fio_transport *host = NULL;
    size_t count = 0;
    CHECK_EQUAL(FIO_OK, fio_tty_open(&host, name, 250000, true));
    rig_turn(pty);
    CHECK_EQUAL(FIO_OK, fio_transport_write(host, bytes, strlen(bytes), &count));
    CHECK(rig_reads(pty, early, "FIRMWARE_NAME"));
    fio_transport_close(host);
    close(early);
    fio_standin_close(pty);
    fio_machine_free(machine);
}

static int connect_path(const char *path) {
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    int file = socket(AF_UNIX, SOCK_STREAM, 0);
    memcpy(address.sun_path, path, strlen(path));
    if (connect(file, (struct sockaddr *)&address, sizeof address) != 0) {
        close(file);
        return -1;
    }
    fcntl(file, F_SETFL, O_NONBLOCK);
    return file;
}

static void test_socket_takes_one_host_after_the_other(void) {
    char path[64];
    path_in(path, "socket");
    fio_machine *machine = rig_machine(true);
    fio_pace pace = fio_pace_start(0);
    fio_standin *server = NULL, *second = NULL;
    CHECK_EQUAL(FIO_OK, fio_standin_socket(&server, machine, &pace, path));
    CHECK_EQUAL(FIO_NOT_WRITTEN, fio_standin_socket(&second, machine, &pace, path)); /* is served */
    rig_turn(server); /* that second one looked whether it is */
    int first = connect_path(path), waiting = connect_path(path);
    CHECK(says(first, "M115\n") && says(waiting, "M105\n"));
    CHECK(rig_reads(server, first, "FIRMWARE_NAME"));
    char byte;
    CHECK(read(waiting, &byte, 1) < 0 && errno == EAGAIN);
    close(first);
    CHECK(rig_reads(server, waiting, "T:"));
    close(waiting);
    rig_turn(server);
    CHECK(!server->connected);
    fio_standin_close(server);
    CHECK(access(path, F_OK) != 0);
    fio_machine_free(machine);
}

static void test_lines_sent_just_before_leaving_are_executed(void) {
    char path[64];
    path_in(path, "brief");
    fio_machine *machine = rig_machine(false);
    fio_pace pace = fio_pace_start(0);
    fio_standin *server = NULL;
    CHECK_EQUAL(FIO_OK, fio_standin_socket(&server, machine, &pace, path));
    int host = connect_path(path);
    for (int i = 0; i < 200; i++)
        CHECK(says(host, "G92 X1\n"));
    close(host);
    rig_turn(server);
    CHECK_EQUAL(200, rig_lines(machine));
    fio_standin_close(server);
    fio_machine_free(machine);
}

static void test_what_is_no_socket_is_not_replaced(void) {
    char path[64];
    path_in(path, "file");
    FILE *file = fopen(path, "w");
    fclose(file);
    fio_machine *machine = rig_machine(false);
    fio_pace pace = fio_pace_start(0);
    fio_standin *server = NULL;
    CHECK_EQUAL(FIO_NOT_WRITTEN, fio_standin_socket(&server, machine, &pace, path));
    CHECK(!server && access(path, F_OK) == 0);
    CHECK_EQUAL(FIO_NOT_WRITTEN, fio_standin_pty(&server, machine, &pace, path));
    CHECK(!server && access(path, F_OK) == 0);
    unlink(path);
    fio_machine_free(machine);
}

static void test_tcp(void) {
    fio_machine *machine = rig_machine(false);
    fio_pace pace = fio_pace_start(0);
    fio_standin *server = NULL;
    CHECK_EQUAL(FIO_OK, fio_standin_tcp(&server, machine, &pace, "127.0.0.1", 0));
    int port = atoi(strrchr(server->where, ':') + 1);
    CHECK(port > 0);
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    int host = socket(AF_INET, SOCK_STREAM, 0);
    CHECK_EQUAL(0, connect(host, (struct sockaddr *)&address, sizeof address));
    fcntl(host, F_SETFL, O_NONBLOCK);
    CHECK(says(host, "M105\n"));
    CHECK(rig_reads(server, host, "ok T:"));
    close(host);
    fio_standin_close(server);
    CHECK_EQUAL(FIO_USAGE, fio_standin_tcp(&server, machine, &pace, "no.such.host.invalid", 1));
    fio_machine_free(machine);
}

/* The machine pulls the plug by a script; the host sees what it would see of an adapter. */
static void test_an_unplugged_terminal_hangs_up(void) {
    char path[64];
    path_in(path, "plug");
    fio_machine *machine = rig_machine(false);
    fio_pace pace = fio_pace_start(0);
    fio_standin *pty = NULL;
    CHECK_EQUAL(FIO_OK, fio_standin_pty(&pty, machine, &pace, path));
    int host = open_terminal(path);
    CHECK(says(host, "M105\n"));
    CHECK(rig_reads(pty, host, "ok"));
    CHECK_EQUAL(FIO_OK, pty->type->plug(pty, false));
    char byte;
    ssize_t got = read(host, &byte, 1);
    CHECK(got == 0 || errno == EIO);
    CHECK(write(host, "M105\n", 5) < 0);
    CHECK(!is_there(path));
    close(host);
    rig_turn(pty);
    CHECK_EQUAL(FIO_OK, pty->type->plug(pty, true));
    host = open_terminal(path);
    CHECK(host >= 0 && says(host, "M105\n"));
    CHECK(rig_reads(pty, host, "ok"));
    close(host);
    fio_standin_close(pty);
    fio_machine_free(machine);
}

/* A host that writes without reading is held back, not buffered without an end, and loses nothing:
 * native USB's behaviour. */
static void test_a_host_that_does_not_read_is_held_back(void) {
    char path[64];
    path_in(path, "pressure");
    fio_machine *machine = rig_machine(false);
    fio_pace pace = fio_pace_start(0);
    fio_standin *server = NULL;
    CHECK_EQUAL(FIO_OK, fio_standin_socket(&server, machine, &pace, path));
    int host = connect_path(path);
    int64_t lines = 0;
    for (int quiet = 0; quiet < 30; rig_turn(server)) {
        ssize_t put = write(host, "M115\n", 5);
        CHECK(put == 5 || (put < 0 && errno == EAGAIN));
        quiet = put < 0 ? quiet + 1 : 0;
        lines += put == 5;
        for (int i = 0; i < 2000 && write(host, "M115\n", 5) == 5; i++)
            lines++;
    }
    CHECK(rig_lines(machine) < lines);
    static char bytes[65536];
    for (int i = 0; i < 3000 && rig_lines(machine) < lines; i++) {
        while (read(host, bytes, sizeof bytes) > 0)
            continue;
        rig_turn(server);
    }
    CHECK_EQUAL(lines, rig_lines(machine));
    close(host);
    fio_standin_close(server);
    fio_machine_free(machine);
}

int main(void) {
    if (!mkdtemp(folder))
        return 1;
    RUN(test_pty_answers_each_host_anew);
    RUN(test_pty_is_raw_and_made_raw_again);
    RUN(test_pty_without_a_host_costs_nothing);
    RUN(test_bytes_at_a_wrong_rate_are_rubbish);
    RUN(test_rates_set_by_their_number_count);
    RUN(test_socket_takes_one_host_after_the_other);
    RUN(test_lines_sent_just_before_leaving_are_executed);
    RUN(test_what_is_no_socket_is_not_replaced);
    RUN(test_tcp);
    RUN(test_an_unplugged_terminal_hangs_up);
    RUN(test_a_host_that_does_not_read_is_held_back);
    rmdir(folder);
    return check_verdict();
}
