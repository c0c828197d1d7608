#include "league_file.h"

#include <stdlib.h>
#include <string.h>

#include "vsss/check.h"

static const vs_section league_section = {"league", 1, 1}, slots_section = {"slots", 1, 1},
                        selves_section = {"selves", 1, 1};

typedef struct league_state {
  int32_t selves, frozen, next_id, replacements, window_at, window_filled;
  double window[VS_LEAGUE_WINDOW];
  vs_league_record record[VS_LEAGUE_KINDS_MAX];
} league_state;

typedef struct self_state {
  int32_t id, in_pool, users;
  double beaten;
} self_state; // followed by the parameters

void vs_league_save(const vs_league *l, vs_bytes *out) {
  league_state state;
  memset(&state, 0, sizeof state); // padding too: equal runs, equal files
  state.selves = l->selves, state.frozen = l->frozen, state.next_id = l->next_id;
  state.replacements = l->replacements, state.window_at = l->window_at, state.window_filled = l->window_filled;
  memcpy(state.window, l->window, sizeof state.window);
  memcpy(state.record, l->record, sizeof state.record);
  vs_archive_section(out, &league_section, &state, sizeof state);
  vs_archive_section(out, &slots_section, l->slot, (size_t)l->slots * sizeof *l->slot);
  size_t each = sizeof(self_state) + l->size * sizeof(float);
  uint8_t *at = vs_archive_room(out, &selves_section, (size_t)l->selves * each);
  for (int i = 0; at && i < l->selves; i++, at += each) {
    self_state self;
    memset(&self, 0, sizeof self);
    self.id = l->self[i].id, self.in_pool = l->self[i].in_pool, self.users = l->self[i].users;
    self.beaten = l->self[i].beaten;
    memcpy(at, &self, sizeof self);
    if (self.id) // a free place keeps nothing worth saving
      memcpy(at + sizeof self, l->self[i].parameters, l->size * sizeof(float));
    else
      memset(at + sizeof self, 0, l->size * sizeof(float));
  }
}

static bool has(const vs_league *l, vs_opponent_kind kind) {
  for (int k = 0; k < l->def.shares; k++)
    if (l->def.share[k].kind == kind) return true;
  return false;
}

static bool state_ok(const vs_league *l, const league_state *s) {
  bool ok = s->selves >= 0 && s->selves <= 1 << 20 && s->next_id >= 0 && s->replacements >= 0 && s->window_at >= 0 &&
            s->window_at < VS_LEAGUE_WINDOW && s->window_filled >= 0 && s->window_filled <= VS_LEAGUE_WINDOW &&
            vs_all_finite(s->window, VS_LEAGUE_WINDOW) && s->frozen >= -1 && s->frozen < s->selves &&
            has(l, VS_OPPONENT_FROZEN) == (s->frozen >= 0);
  for (int k = 0; k < VS_LEAGUE_KINDS_MAX; k++) {
    const vs_league_record *r = &s->record[k];
    ok =
        ok && r->episodes >= 0 && r->wins >= 0 && r->draws >= 0 && r->losses >= 0 && vs_all_finite(&r->recent_score, 1);
  }
  return ok;
}

static self_state self_at(const void *selves, size_t each, int index) {
  self_state self;
  memcpy(&self, (const uint8_t *)selves + (size_t)index * each, sizeof self);
  return self;
}

static bool self_ok(const self_state *self, int next_id, const vs_league_slot *slot, int slots, int index) {
  int users = 0;
  for (int i = 0; i < slots; i++) users += slot[i].self == index;
  bool free_place = self->id == 0;
  return self->id >= 0 && self->id <= next_id && (self->in_pool == 0 || self->in_pool == 1) && self->users == users &&
         vs_all_finite(&self->beaten, 1) && self->beaten >= 0.0 && self->beaten <= 1.0 &&
         !(free_place && (self->in_pool || users));
}

// Kind and side of a slot follow from the settings; the self it meets is there where it meets one.
static bool slot_ok(const vs_league *l, const vs_league_slot *slot, int index, int selves) {
  const vs_league_slot *mine = &l->slot[index];
  vs_opponent_kind kind = vs_league_kind(l, index);
  bool meets = kind == VS_OPPONENT_FROZEN || kind == VS_OPPONENT_POOL;
  return slot->share == mine->share && slot->learner == mine->learner &&
         (meets ? slot->self >= 0 && slot->self < selves : slot->self == -1);
}

static bool slots_ok(const vs_league *l, const league_state *s, const vs_league_slot *slot, int slots) {
  for (int i = 0; i < slots; i++)
    if (!slot_ok(l, &slot[i], i, s->selves)) return false;
  return slots == l->slots;
}

static bool members_ok(const vs_league *l, const league_state *s, const vs_league_slot *slot, int slots,
                       const void *selves, size_t each) {
  int members = 0;
  for (int i = 0; i < s->selves; i++) {
    self_state self = self_at(selves, each, i);
    if (!self_ok(&self, s->next_id, slot, slots, i)) return false;
    if (i == s->frozen && self.id == 0) return false;
    members += self.in_pool;
  }
  return members > 0 || !has(l, VS_OPPONENT_POOL);
}

static vs_status take_selves(vs_league *l, const uint8_t *at, int count, vs_error *err) {
  vs_frozen_self *grown = realloc(l->self, (size_t)(count > l->selves ? count : l->selves) * sizeof *grown);
  if (!grown && count > 0) return vs_fail(err, VS_FAIL, "out of memory for %d frozen opponents", count);
  if (grown) l->self = grown;
  for (; l->selves < count; l->selves++) l->self[l->selves] = (vs_frozen_self){0};
  for (int i = 0; i < l->selves; i++) {
    vs_frozen_self *self = &l->self[i];
    self_state state = {0};
    if (i < count) memcpy(&state, at, sizeof state);
    self->id = state.id, self->in_pool = state.in_pool, self->users = state.users, self->beaten = state.beaten;
    if (i >= count) continue;
    if (!self->parameters) self->parameters = malloc(l->size * sizeof(float));
    if (!self->parameters) return vs_fail(err, VS_FAIL, "out of memory for %d frozen opponents", count);
    memcpy(self->parameters, at + sizeof state, l->size * sizeof(float));
    if (!vs_all_finite_floats(self->parameters, l->size))
      return vs_fail(err, VS_FAIL, "a frozen opponent holds what is no number");
    at += sizeof state + l->size * sizeof(float);
  }
  return VS_OK;
}

vs_status vs_league_load(vs_league *l, const vs_bytes *archive, const char *path, bool new_slots, vs_error *err) {
  vs_found found, slots, selves;
  league_state state;
  vs_status s = vs_archive_find(archive, path, &league_section, sizeof state, &found, err);
  if (s != VS_OK) return s;
  memcpy(&state, found.data, sizeof state);
  if (!state_ok(l, &state)) return vs_fail(err, VS_FAIL, "%s: 'league' holds a number that no run has", path);
  size_t slots_size = (size_t)l->slots * sizeof *l->slot, each = sizeof(self_state) + l->size * sizeof(float);
  s = vs_archive_find(archive, path, &slots_section, new_slots ? 0 : slots_size, &slots, err);
  if (s == VS_OK) s = vs_archive_find(archive, path, &selves_section, (size_t)state.selves * each, &selves, err);
  if (s != VS_OK) return s;
  vs_league_slot *slot = malloc(slots.size + 1); // aligned, which the file's bytes need not be; maybe of no slot
  int count = (int)(slots.size / sizeof *slot);
  if (!slot) return vs_fail(err, VS_FAIL, "%s: out of memory", path);
  memcpy(slot, slots.data, slots.size);
  if (selves.size != (size_t)state.selves * each || !(new_slots || slots_ok(l, &state, slot, count)) ||
      !members_ok(l, &state, slot, count, selves.data, each))
    s = vs_fail(err, VS_FAIL, "%s: 'slots' or 'selves' hold a number that no run has", path);
  else if (take_selves(l, selves.data, state.selves, err) != VS_OK)
    s = vs_fail_prefix(err, "%s", path);
  if (s == VS_OK) {
    l->frozen = state.frozen, l->next_id = state.next_id, l->replacements = state.replacements;
    l->window_at = state.window_at, l->window_filled = state.window_filled;
    memcpy(l->window, state.window, sizeof state.window);
    memcpy(l->record, state.record, sizeof state.record);
    if (new_slots)
      vs_league_begin_episodes(l);
    else
      memcpy(l->slot, slot, slots_size);
  }
  free(slot);
  return s;
}
