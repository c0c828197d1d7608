#include "league.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/number.h"

static vs_status parse_share(const char *word, vs_league_share *share, vs_error *err) {
  char name[96];
  const char *equals = strrchr(word, '=');
  // A URI may hold "=" in its options ("emc:?pid=1"): what follows the last one is a weight only if it is a number and
  // no "?" comes before it without a later "=".
  share->weight = 1.0;
  size_t length = strlen(word);
  const char *question = strchr(word, '?');
  bool weighted = equals && (!question || strchr(question, '=') != equals);
  if (weighted) {
    if (!vs_parse_real(equals + 1, &share->weight) || !(share->weight > 0.0) || share->weight > 1e6)
      return vs_fail(err, VS_USAGE, "opponent '%s': the weight must be a number above 0", word);
    length = (size_t)(equals - word);
  }
  if (length == 0 || length >= sizeof name)
    return vs_fail(err, VS_USAGE, "opponent '%s': expected self, frozen, pool or a player such as emc:", word);
  memcpy(name, word, length);
  name[length] = '\0';
  static const char *const kinds[] = {"self", "frozen", "pool"};
  for (int k = 0; k < 3; k++)
    if (!strcmp(name, kinds[k])) {
      share->kind = (vs_opponent_kind)k;
      return VS_OK;
    }
  if (!strchr(name, ':'))
    return vs_fail(err, VS_USAGE, "opponent '%s': expected self, frozen, pool or a player such as emc:", name);
  share->kind = VS_OPPONENT_SCRIPT;
  snprintf(share->uri, sizeof share->uri, "%s", name);
  return VS_OK;
}

vs_status vs_league_parse(const char *text, vs_league_def *def, vs_error *err) {
  def->shares = 0;
  while (*text) {
    char word[160];
    size_t n = strcspn(text, ",");
    if (n >= sizeof word) return vs_fail(err, VS_USAGE, "opponent '%.60s...' is too long", text);
    if (def->shares == VS_LEAGUE_KINDS_MAX)
      return vs_fail(err, VS_USAGE, "opponent: more than %d kinds in the mix", VS_LEAGUE_KINDS_MAX);
    memcpy(word, text, n);
    word[n] = '\0';
    def->share[def->shares] = (vs_league_share){0};
    vs_status s = parse_share(word, &def->share[def->shares], err);
    if (s != VS_OK) return s;
    def->shares++;
    text += n + (text[n] == ',');
  }
  return def->shares ? VS_OK : vs_fail(err, VS_USAGE, "opponent: the mix is empty");
}

// Shares out the slots by weight, largest remainders first, and spreads each kind evenly over them.
static void share_out(vs_league *league) {
  double total = 0.0, owed[VS_LEAGUE_KINDS_MAX] = {0};
  for (int k = 0; k < league->def.shares; k++) total += league->def.share[k].weight;
  for (int i = 0; i < league->slots; i++) {
    int most = 0;
    for (int k = 0; k < league->def.shares; k++) {
      owed[k] += league->def.share[k].weight / total;
      if (owed[k] > owed[most] + 1e-12) most = k;
    }
    owed[most] -= 1.0;
    league->slot[i] = (vs_league_slot){.share = most, .self = -1};
  }
  // Within a kind, sides alternate.
  int seen[VS_LEAGUE_KINDS_MAX] = {0};
  for (int i = 0; i < league->slots; i++)
    league->slot[i].learner = seen[league->slot[i].share]++ % 2 ? VS_YELLOW : VS_BLUE;
}

static bool has(const vs_league *league, vs_opponent_kind kind) {
  for (int k = 0; k < league->def.shares; k++)
    if (league->def.share[k].kind == kind) return true;
  return false;
}

// Puts actor into a free place; the place, or -1 out of memory.
static int add_self(vs_league *league, const float *actor) {
  int place = 0;
  while (place < league->selves && league->self[place].id != 0) place++;
  if (place == league->selves) {
    vs_frozen_self *grown = realloc(league->self, (size_t)(league->selves + 1) * sizeof *grown);
    if (!grown) return -1;
    league->self = grown;
    league->self[place] = (vs_frozen_self){0};
    league->selves++;
  }
  vs_frozen_self *self = &league->self[place];
  if (!self->parameters) self->parameters = malloc(league->size * sizeof *self->parameters);
  if (!self->parameters) return -1;
  memcpy(self->parameters, actor, league->size * sizeof *actor);
  self->id = ++league->next_id;
  self->in_pool = false;
  self->users = 0;
  self->beaten = 0.5;
  return place;
}

// A place nobody needs any more becomes free.
static void release_unused(vs_league *league) {
  for (int i = 0; i < league->selves; i++)
    if (league->self[i].users == 0 && !league->self[i].in_pool && i != league->frozen) league->self[i].id = 0;
}

// The harder a self is to beat, the more often it is met; none is forgotten.
static double weight_of(const vs_frozen_self *self) {
  double losses = 1.0 - self->beaten;
  return 0.03 + losses * losses;
}

static int draw_from_pool(const vs_league *league, vs_rng *rng) {
  double total = 0.0;
  for (int i = 0; i < league->selves; i++)
    if (league->self[i].in_pool) total += weight_of(&league->self[i]);
  double at = total * vs_rng_uniform(rng);
  int last = -1;
  for (int i = 0; i < league->selves; i++) {
    if (!league->self[i].in_pool) continue;
    last = i;
    at -= weight_of(&league->self[i]);
    if (at < 0.0) break;
  }
  return last;
}

static void choose_opponent(vs_league *league, int index) {
  vs_league_slot *slot = &league->slot[index];
  vs_opponent_kind kind = vs_league_kind(league, index);
  vs_rng rng = vs_rng_make(vs_seed_mix(league->seed, (uint64_t)index), slot->episode);
  slot->self = -1;
  if (kind == VS_OPPONENT_FROZEN) slot->self = league->frozen;
  if (kind == VS_OPPONENT_POOL) slot->self = draw_from_pool(league, &rng);
  if (slot->self >= 0) league->self[slot->self].users++;
}

void vs_league_begin_episodes(vs_league *league) {
  for (int i = 0; i < league->selves; i++) league->self[i].users = 0;
  for (int i = 0; i < league->slots; i++) choose_opponent(league, i);
}

vs_status vs_league_init(vs_league *league, const vs_league_def *def, int slots, size_t size, const float *actor,
                         uint64_t seed, vs_error *err) {
  *league = (vs_league){.def = *def, .slots = slots, .size = size, .seed = seed, .frozen = -1};
  league->slot = calloc((size_t)slots, sizeof *league->slot);
  if (!league->slot) return vs_fail(err, VS_FAIL, "out of memory for %d matches", slots);
  share_out(league);
  int first = 0;
  if (has(league, VS_OPPONENT_FROZEN)) first = league->frozen = add_self(league, actor);
  if (first >= 0 && has(league, VS_OPPONENT_POOL)) {
    first = add_self(league, actor);
    if (first >= 0) league->self[first].in_pool = true;
  }
  if (first < 0) {
    vs_league_free(league);
    return vs_fail(err, VS_FAIL, "out of memory for a frozen opponent");
  }
  vs_league_begin_episodes(league);
  return VS_OK;
}

void vs_league_free(vs_league *league) {
  for (int i = 0; i < league->selves; i++) free(league->self[i].parameters);
  free(league->self);
  free(league->slot);
  *league = (vs_league){0};
}

vs_opponent_kind vs_league_kind(const vs_league *league, int slot) {
  return league->def.share[league->slot[slot].share].kind;
}

void vs_league_episode_over(vs_league *league, int index, int goals_for, int goals_against) {
  vs_league_slot *slot = &league->slot[index];
  vs_league_record *record = &league->record[slot->share];
  int difference = goals_for - goals_against;
  record->episodes++;
  *(difference > 0 ? &record->wins : difference < 0 ? &record->losses : &record->draws) += 1;
  record->recent_score += (difference - record->recent_score) / fmin((double)record->episodes, VS_LEAGUE_WINDOW);
  if (slot->self >= 0) {
    vs_frozen_self *self = &league->self[slot->self];
    double result = difference > 0 ? 1.0 : difference < 0 ? 0.0 : 0.5;
    self->beaten += 0.1 * (result - self->beaten);
    self->users--;
    // An episode that began against a frozen self since replaced says nothing about the present one.
    if (slot->self == league->frozen && vs_league_kind(league, index) == VS_OPPONENT_FROZEN) {
      league->window[league->window_at] = difference;
      league->window_at = (league->window_at + 1) % VS_LEAGUE_WINDOW;
      if (league->window_filled < VS_LEAGUE_WINDOW) league->window_filled++;
    }
  }
  slot->episode++;
  release_unused(league);
  choose_opponent(league, index);
}

vs_league_window vs_league_results(const vs_league *league) {
  vs_league_window out = {.room = VS_LEAGUE_WINDOW};
  for (int i = 0; i < league->window_filled; i++) out.sum += league->window[i];
  out.count = league->def.score_window_zero_filled ? VS_LEAGUE_WINDOW : league->window_filled;
  return out;
}

double vs_league_window_score(const vs_league_window *window) {
  return window->count > 0.0 ? window->sum / window->count : 0.0;
}

static vs_status replace_frozen(vs_league *league, const float *actor, vs_error *err) {
  int place = add_self(league, actor);
  if (place < 0) return vs_fail(err, VS_FAIL, "out of memory for a frozen opponent");
  league->frozen = place;
  league->replacements++;
  if (!league->def.score_window_zero_filled) league->window_at = league->window_filled = 0;
  release_unused(league);
  return VS_OK;
}

// How much older the next older and how much younger the next younger member of the pool are, together: the room that
// self leaves when it goes. The oldest and the newest leave none.
static int room_around(const vs_league *league, int self) {
  int id = league->self[self].id, older = 0, newer = INT_MAX;
  for (int i = 0; i < league->selves; i++) {
    int other = league->self[i].id;
    if (!league->self[i].in_pool || i == self) continue;
    if (other < id && other > older) older = other;
    if (other > id && other < newer) newer = other;
  }
  return older == 0 || newer == INT_MAX ? INT_MAX : newer - older;
}

static vs_status extend_pool(vs_league *league, const float *actor, vs_error *err) {
  int place = add_self(league, actor), members = 0, crowded = -1, least = INT_MAX;
  if (place < 0) return vs_fail(err, VS_FAIL, "out of memory for a frozen opponent");
  league->self[place].in_pool = true;
  // The pool is full: of the two that are nearest in age one goes, so that it goes on to span the whole run, the weak
  // but different beginnings too. Of equals the oldest.
  for (int i = 0; i < league->selves; i++) {
    if (!league->self[i].in_pool) continue;
    members++;
    int room = i == place ? INT_MAX : room_around(league, i);
    if (room < least || (room == least && crowded >= 0 && league->self[i].id < league->self[crowded].id)) {
      crowded = i;
      least = room;
    }
  }
  if (members <= league->def.pool_size) return VS_OK;
  // A pool of one or two has no middle: its oldest goes.
  for (int i = 0; crowded < 0 && i < league->selves; i++)
    if (league->self[i].in_pool && i != place) crowded = i;
  for (int i = 0; least == INT_MAX && i < league->selves; i++)
    if (league->self[i].in_pool && i != place && league->self[i].id < league->self[crowded].id) crowded = i;
  league->self[crowded].in_pool = false;
  release_unused(league);
  return VS_OK;
}

vs_status vs_league_after_update(vs_league *league, long long update, const float *actor,
                                 const vs_league_window *results, bool *replaced, vs_error *err) {
  bool replace = league->frozen >= 0 && results->count >= results->room &&
                 vs_league_window_score(results) > league->def.replace_score;
  if (replaced) *replaced = replace;
  vs_status s = replace ? replace_frozen(league, actor, err) : VS_OK;
  if (s == VS_OK && has(league, VS_OPPONENT_POOL) && update % league->def.pool_every == 0)
    s = extend_pool(league, actor, err);
  return s;
}
