// Results of matches as a table for people, JSON and CSV for programs. Seen from blue.
#ifndef VSSS_CLI_REPORT_H
#define VSSS_CLI_REPORT_H

#include <stdio.h>

#include "match_flags.h"
#include "vsss/eval.h"

// A name in a column of so many characters (of UTF-8), below 0 at its right end. A long one, such as a file's, is cut at
// its front: its end tells it from others.
void vs_report_name(FILE *out, const char *name, int width);

void vs_report_table_head(FILE *out);
void vs_report_table_row(FILE *out, const char *against, const vs_series_summary *summary);
void vs_report_restarts_head(FILE *out);
void vs_report_restarts_row(FILE *out, const char *against, const vs_series_summary *summary);
// A line where a player broke the idle rule, per match; nothing where it did not.
// How many matches of a knockout series went beyond their time; nothing where none did.
void vs_report_knockout(FILE *out, const char *against, const vs_series_summary *summary);

void vs_report_idle(FILE *out, const char *player, double warnings, double sent_off);

void vs_report_csv_head(FILE *out);
void vs_report_csv_row(FILE *out, const char *blue, const char *yellow, const vs_series_summary *summary);

// JSON: "name": value pairs of the flags; an object for one match and for a summary. What is not a
// number (an interval of no match) is null.
void vs_report_json_flags(FILE *out, const vs_match_flags *flags);
void vs_report_json_match(FILE *out, const vs_match_result *match);
void vs_report_json_matches(FILE *out, const vs_match_result *results, int n); // an array of those begun
void vs_report_json_summary(FILE *out, const vs_series_summary *summary);

#endif
