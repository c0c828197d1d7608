#ifndef VSSS_LEAGUE_NET_PROCESS_NAME_H
#define VSSS_LEAGUE_NET_PROCESS_NAME_H

#include <stddef.h>

// "process 123 (./vsss serve --blue net)"
void vs_process_name(int pid, char *out, size_t out_size);

#endif
