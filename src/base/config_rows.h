// Rows of a schema (vsss/config.h) whose keys are named as the fields of the struct that a pointer `d` points to. For a
// file that is about its schema: the names are short.
#ifndef VSSS_BASE_CONFIG_ROWS_H
#define VSSS_BASE_CONFIG_ROWS_H

#include "vsss/config.h"

#define TEXT(field, help)                                                                                              \
  { #field, VS_CONFIG_TEXT, d->field, sizeof d->field, 0, 0, help }
#define WHOLE(field, min, max, help)                                                                                   \
  { #field, VS_CONFIG_INT, &d->field, 0, min, max, help }
#define REAL(field, min, max, help)                                                                                    \
  { #field, VS_CONFIG_REAL, &d->field, 0, min, max, help }
#define SWITCH(field, help)                                                                                            \
  { #field, VS_CONFIG_BOOL, &d->field, 0, 0, 0, help }
#define SEED(field, help)                                                                                              \
  { #field, VS_CONFIG_SEED, &d->field, 0, 0, 0, help }
#define ALIAS(old, now)                                                                                                \
  { #old, VS_CONFIG_ALIAS, NULL, 0, 0, 0, #now }

#endif
