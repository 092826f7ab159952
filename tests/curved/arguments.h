/* What a check is asked for: words, and numbers split by commas. */
#ifndef TESTS_CURVED_ARGUMENTS_H
#define TESTS_CURVED_ARGUMENTS_H

typedef struct argument {
    const char *name;  /* "--like-this"; "": a word without a name */
    const char **word; /* takes what follows; or */
    int count;         /* that many numbers follow, */
    double *number;    /* for these; 0: it becomes 1 */
} argument;

/* 0 if they can't be understood, which it has told of. */
int arguments_read(const argument *known, int known_count, int count, char **word);

#endif
