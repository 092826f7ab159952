#include "standin/terminal_rate.h"

/* Arbitrary rates need the kernel's own struct termios2, which can't be had together with
 * <termios.h>: so this is a file of its own. */
#include <asm/termbits.h>
#include <sys/ioctl.h>

int64_t fio_terminal_rate(int file) {
    struct termios2 modes;
    return ioctl(file, TCGETS2, &modes) == 0 ? (int64_t)modes.c_ospeed : 0;
}
