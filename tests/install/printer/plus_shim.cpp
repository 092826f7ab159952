// The headers as a program in C++ meets them.
#include <isoprint/machine.h>
#include <isoprint/port.h>
#include <isoprint/virtual_printer.h>

extern "C" int ports_here() {
    fio_port *ports = nullptr;
    int count = 0;
    if (fio_ports_list(&ports, &count) != FIO_OK)
        return -1;
    fio_ports_free(ports);
    return count;
}
