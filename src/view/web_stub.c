// In place of web.c where libcivetweb is missing.
#include "vsss/view.h"

vs_status vs_view_open(const char *page, const char *data, size_t data_size, const char *address, int port,
                       vs_view **out, vs_error *err) {
  (void)page, (void)data, (void)data_size, (void)address, (void)port, (void)out;
  return vs_fail(err, VS_FAIL, "built without libcivetweb: apt install libcivetweb-dev, then run make again");
}
void vs_view_close(vs_view *view) { (void)view; }
void vs_view_send(vs_view *view, const char *text, size_t size) { (void)view, (void)text, (void)size; }
int vs_view_watchers(vs_view *view) {
  (void)view;
  return 0;
}
