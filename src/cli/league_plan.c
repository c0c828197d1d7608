// Who meets whom in a league, from its file and what was played: nothing else is remembered.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "league.h"

int league_group(const league_file *f, int club) { return club % f->groups; }
int league_last_group_round(const league_file *f) { return f->format == LEAGUE_KNOCKOUT ? 0 : f->rounds; }
bool league_is_knockout(const league_file *f, const league_result *m) { return m->round > league_last_group_round(f); }

int league_winner(const league_result *m) {
  if (m->forfeits == 3) return -1;
  int ahead = m->score[VS_BLUE] - m->score[VS_YELLOW];
  if (ahead == 0) ahead = m->shoot_out[VS_BLUE] - m->shoot_out[VS_YELLOW];
  if (ahead == 0) return m->lot ? m->club[m->lot - 1] : -1;
  return m->club[ahead > 0 ? VS_BLUE : VS_YELLOW];
}

static int entrants(const league_file *f) {
  if (f->format == LEAGUE_ROUND_ROBIN) return 0;
  return f->format == LEAGUE_KNOCKOUT ? f->clubs : f->groups * f->advance;
}

int league_rounds(const league_file *f) {
  int rounds = 0;
  while (1 << rounds < entrants(f)) rounds++;
  return league_last_group_round(f) + rounds;
}

int league_of(const league_file *f) {
  int of = entrants(f) > 0 ? entrants(f) - 1 : 0;
  for (int g = 0; g < f->groups && f->format != LEAGUE_KNOCKOUT; g++) {
    int clubs = 0;
    for (int i = 0; i < f->clubs; i++) clubs += league_group(f, i) == g;
    of += f->rounds * clubs * (clubs - 1);
  }
  return of;
}

static int by_points(const void *a, const void *b) {
  const league_standing *x = a, *y = b;
  if (x->points != y->points) return y->points - x->points;
  int dx = x->goals - x->against, dy = y->goals - y->against;
  if (dx != dy) return dy - dx;
  return y->goals != x->goals ? y->goals - x->goals : x->club - y->club;
}

int league_standings(const league_file *f, const league_result *r, int n, int group,
                     league_standing out[LEAGUE_CLUBS]) {
  int clubs = 0;
  for (int i = 0; i < f->clubs; i++) {
    if (league_group(f, i) != group) continue;
    league_standing *s = &out[clubs++];
    *s = (league_standing){.club = i};
    for (int k = 0; k < n; k++)
      for (int t = 0; t < VS_TEAMS; t++) {
        if (r[k].club[t] != i || league_is_knockout(f, &r[k])) continue;
        int own = r[k].score[t], other = r[k].score[!t];
        bool both = r[k].forfeits == 3; // both lost
        s->played++;
        s->goals += own;
        s->against += other;
        s->won += own > other;
        s->drawn += own == other && !both;
        s->lost += own < other || both;
        s->points += own > other ? 3 : own == other && !both ? 1 : 0;
      }
  }
  qsort(out, (size_t)clubs, sizeof *out, by_points);
  return clubs;
}

static const league_result *find(const league_result *r, int n, int round, int blue, int yellow) {
  for (int k = 0; k < n; k++)
    if (r[k].round == round && r[k].club[VS_BLUE] == blue && r[k].club[VS_YELLOW] == yellow) return &r[k];
  return NULL;
}

static bool next_in_groups(const league_file *f, const league_result *r, int n, league_result *out) {
  for (int round = 1; round <= league_last_group_round(f); round++)
    for (int i = 0; i < f->clubs; i++)
      for (int k = 0; k < f->clubs; k++) {
        if (i == k || league_group(f, i) != league_group(f, k) || find(r, n, round, i, k)) continue;
        *out = (league_result){.round = round, .club = {i, k}};
        return true;
      }
  return false;
}

// The first round's places in the bracket's order, -1: nobody, so that its neighbour goes on. Seeds are the file's order,
// or the groups' firsts, then their seconds: 1 and 2 meet in the final at the earliest, and clubs of a group late.
static int bracket(const league_file *f, const league_result *r, int n, int place[LEAGUE_CLUBS]) {
  int seed[LEAGUE_CLUBS], seeds = entrants(f), size = 1, order[LEAGUE_CLUBS] = {0};
  for (int k = 0; k < seeds; k++) seed[k] = k;
  for (int g = 0; g < f->groups && f->format == LEAGUE_IN_GROUPS; g++) {
    league_standing table[LEAGUE_CLUBS];
    league_standings(f, r, n, g, table);
    for (int k = 0; k < f->advance; k++) seed[k * f->groups + g] = table[k].club;
  }
  while (size < seeds) {
    size *= 2;
    for (int k = size / 2 - 1; k >= 0; k--) {
      order[2 * k + 1] = size - 1 - order[k];
      order[2 * k] = order[k];
    }
  }
  for (int k = 0; k < size; k++) place[k] = order[k] < seeds ? seed[order[k]] : -1;
  return size;
}

// Follows the knockout as far as it was played. True: *out is to be played next; else *champion has won it (-1: nobody).
static bool follow(const league_file *f, const league_result *r, int n, league_result *out, int *champion) {
  int place[LEAGUE_CLUBS], round = league_last_group_round(f);
  for (int size = bracket(f, r, n, place); size > 1; size /= 2) {
    round++;
    for (int k = 0; k < size / 2; k++) {
      int a = place[2 * k], b = place[2 * k + 1];
      const league_result *played = find(r, n, round, a, b);
      if (a >= 0 && b >= 0 && !played) {
        *out = (league_result){.round = round, .club = {a, b}};
        return true;
      }
      place[k] = played ? league_winner(played) : a >= 0 ? a : b;
    }
  }
  *champion = place[0];
  return false;
}

bool league_next(const league_file *f, const league_result *r, int n, league_result *out) {
  int champion;
  if (next_in_groups(f, r, n, out)) return true;
  return entrants(f) > 1 && follow(f, r, n, out, &champion);
}

int league_champion(const league_file *f, const league_result *r, int n) {
  league_result next;
  int champion = -1;
  if (entrants(f) < 2 || next_in_groups(f, r, n, &next) || follow(f, r, n, &next, &champion)) return -1;
  return champion;
}

const char *league_round_name(const league_file *f, int round) {
  static const char *const names[] = {"final", "semi-final", "quarter-final", "round of 16"};
  return names[league_rounds(f) - round];
}
