#include "serial/serial.h"

typedef struct board {
    uint16_t vendor, product;
    bool certain; /* a printer's, or a board's that is nearly always one */
    const char *name;
} board;

static const board boards[] = {
    {0x2341, 0x0010, true, "Arduino Mega 2560"},
    {0x2341, 0x0042, true, "Arduino Mega 2560 R3"},
    {0x2a03, 0x0042, true, "Arduino Mega 2560 R3"},
    {0x2341, 0x003d, true, "Arduino Due (programming port)"},
    {0x2341, 0x003e, true, "Arduino Due (native port)"},
    {0x1d50, 0x6015, true, "Smoothieboard"},
    {0x1d50, 0x6029, true, "Marlin (native USB)"},
    {0x1d50, 0x60ec, true, "Duet 2"},
    {0x1d50, 0x60ed, true, "Duet 2 Maestro"},
    {0x1d50, 0x60ee, true, "Duet 3"},
    {0x1d50, 0x614e, true, "Klipper"},
    {0x27b1, 0x0001, true, "RAMBo"},
    {0x2c99, 0x0001, true, "Prusa i3 MK2"},
    {0x2c99, 0x0002, true, "Prusa i3 MK3"},
    {0x0483, 0x5740, false, "STM32 virtual COM port"},
    {0x1eaf, 0x0004, false, "Maple (STM32)"},
    {0x16c0, 0x0483, false, "Teensy"},
    {0x1a86, 0x7523, false, "CH340"},
    {0x1a86, 0x7522, false, "CH340K"},
    {0x1a86, 0x5523, false, "CH341A"},
    {0x1a86, 0x55d4, false, "CH9102"},
    {0x4348, 0x5523, false, "CH341"},
    {0x0403, 0x6001, false, "FT232R"},
    {0x0403, 0x6010, false, "FT2232"},
    {0x0403, 0x6011, false, "FT4232H"},
    {0x0403, 0x6014, false, "FT232H"},
    {0x0403, 0x6015, false, "FT231X"},
    {0x10c4, 0xea60, false, "CP2102"},
    {0x10c4, 0xea61, false, "CP210x"},
    {0x10c4, 0xea63, false, "CP210x"},
    {0x10c4, 0xea70, false, "CP2105"},
    {0x10c4, 0xea71, false, "CP2108"},
    {0x067b, 0x2303, false, "PL2303"},
    {0x067b, 0x2304, false, "PL2303"},
    {0x067b, 0x23a3, false, "PL2303GC"},
    {0x067b, 0x23b3, false, "PL2303GB"},
    {0x067b, 0x23c3, false, "PL2303GT"},
    {0x067b, 0x23d3, false, "PL2303GL"},
    {0x067b, 0x23e3, false, "PL2303GE"},
    {0x067b, 0x23f3, false, "PL2303GS"},
};

const char *fio_serial_board(uint16_t vendor, uint16_t product, bool *certain) {
    *certain = false;
    for (size_t i = 0; i < sizeof boards / sizeof *boards; i++) {
        if (boards[i].vendor != vendor || boards[i].product != product)
            continue;
        *certain = boards[i].certain;
        return boards[i].name;
    }
    return NULL;
}

bool fio_serial_board_at(int index, uint16_t *vendor, uint16_t *product) {
    if (index < 0 || (size_t)index >= sizeof boards / sizeof *boards)
        return false;
    *vendor = boards[index].vendor;
    *product = boards[index].product;
    return true;
}
