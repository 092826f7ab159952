#include <isoprint/port.h>

fio_port_options fio_port_options_defaults(void) {
    return (fio_port_options){.rate = 115200};
}
