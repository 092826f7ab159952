/* Reports of temperatures and positions within answers. */
#ifndef FIO_PROTOCOL_REPORT_H
#define FIO_PROTOCOL_REPORT_H

#include "protocol/answer.h"
#include "protocol/words.h"

/* Both want all of the line to be of the form of a report; else *answer is as it was. */
bool fio_report_temperatures(fio_answer *answer, fio_words words);
bool fio_report_position(fio_answer *answer, fio_words words);

#endif
