/* The word someone meant. */
#ifndef FIO_CLI_NEAREST_H
#define FIO_CLI_NEAREST_H

/* Insertions, deletions and changes of letters between two words; '_' and '-' are the same. */
int fio_nearest_distance(const char *known, const char *given);

/* The largest distance at which a word is still worth suggesting. */
int fio_nearest_tolerance(const char *given);

#endif
