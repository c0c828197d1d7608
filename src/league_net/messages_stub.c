// In place of messages.c where protobuf-c is missing.
#include "vsss/league_messages.h"

vs_status vs_league_supported(vs_error *err) {
  return vs_fail(err, VS_FAIL,
                 "built without protobuf-c: apt install libprotobuf-c-dev protobuf-c-compiler, then run make again");
}

size_t vs_fira_environment_encode(const vs_fira_environment *environment, uint8_t *out, size_t out_size) {
  (void)environment, (void)out, (void)out_size;
  return 0;
}
vs_status vs_fira_environment_decode(const uint8_t *data, size_t size, vs_fira_environment *out, vs_error *err) {
  (void)data, (void)size, (void)out;
  return vs_league_supported(err);
}
size_t vs_fira_packet_encode(const vs_fira_packet *packet, bool degrees, uint8_t *out, size_t out_size) {
  (void)packet, (void)degrees, (void)out, (void)out_size;
  return 0;
}
vs_status vs_fira_packet_decode(const uint8_t *data, size_t size, bool degrees, vs_fira_packet *out, vs_error *err) {
  (void)data, (void)size, (void)degrees, (void)out;
  return vs_league_supported(err);
}
void vs_fira_packet_fit(vs_fira_packet *packet, vs_division division) { (void)packet, (void)division; }
size_t vs_ref_command_encode(const vs_ref_command *command, uint8_t *out, size_t out_size) {
  (void)command, (void)out, (void)out_size;
  return 0;
}
vs_status vs_ref_command_decode(const uint8_t *data, size_t size, vs_ref_command *out, vs_error *err) {
  (void)data, (void)size, (void)out;
  return vs_league_supported(err);
}
size_t vs_ref_placement_encode(const vs_ref_placement *placement, uint8_t *out, size_t out_size) {
  (void)placement, (void)out, (void)out_size;
  return 0;
}
vs_status vs_ref_placement_decode(const uint8_t *data, size_t size, vs_ref_placement *out, vs_error *err) {
  (void)data, (void)size, (void)out;
  return vs_league_supported(err);
}
