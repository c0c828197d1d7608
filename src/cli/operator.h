// Who lets the robots move and who stops them: keys on standard input, and words in a file that another program writes (a
// pipe to a network referee's client).
#ifndef VSSS_CLI_OPERATOR_H
#define VSSS_CLI_OPERATOR_H

#include "vsss/status.h"

typedef enum vs_order { VS_ORDER_NONE, VS_ORDER_GO, VS_ORDER_STOP, VS_ORDER_QUIT } vs_order;

#define VS_OPERATOR_KEYS "g: go, space or any other key: stop, q: end"

typedef struct vs_operator {
  int keys, words; // file descriptors; -1: none
  char word[16];
  int used;
} vs_operator;

// Keys act at once, without Enter, where standard input is a terminal; vs_operator_close gives the terminal back as it
// was. words: a file, such as a named pipe, with a word a line: go, stop, halt (as stop); NULL: none. VS_FAIL: it cannot
// be read.
vs_status vs_operator_open(const char *words, vs_operator *out, vs_error *err);
void vs_operator_close(vs_operator *operator_);

// What was said since the last call; a stop goes before everything. Never waits. unknown (24 bytes): a word that is none,
// else "".
vs_order vs_operator_poll(vs_operator *operator_, char *unknown);

// What was typed since the last call, for keys of another meaning. 0 unless standard input is a terminal and this program is in
// its foreground: a program in the background may not read, and a pipe may be another's.
int vs_operator_typed(vs_operator *operator_, char *out, int size);

#endif
