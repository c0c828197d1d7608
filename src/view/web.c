#include <civetweb.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/view.h"

enum { WATCHERS = 16 };

struct vs_view {
  struct mg_context *web;
  char *page;
  size_t page_size;
  const char *data;
  size_t data_size;
  pthread_mutex_t lock;
  struct mg_connection *watcher[WATCHERS];
};

static int answer(struct mg_connection *c, const char *type, const void *body, size_t size) {
  mg_printf(c,
            "HTTP/1.1 200 OK\r\nContent-Type: %s\r\nContent-Length: %zu\r\nCache-Control: no-store\r\n"
            "Content-Security-Policy: default-src 'self' 'unsafe-inline' data:\r\n\r\n",
            type, size);
  mg_write(c, body, size);
  return 200;
}

static int on_page(struct mg_connection *c, void *context) {
  const vs_view *v = context;
  const char *uri = mg_get_request_info(c)->local_uri;
  if (strcmp(uri, "/") == 0) return answer(c, "text/html; charset=utf-8", v->page, v->page_size);
  if (strcmp(uri, "/data.json") == 0) return answer(c, "application/json", v->data, v->data_size);
  mg_send_http_error(c, 404, "no such page");
  return 404;
}

static int on_connect(const struct mg_connection *c, void *context) {
  (void)c;
  vs_view *v = context;
  return vs_view_watchers(v) < WATCHERS ? 0 : 1;
}

static void on_ready(struct mg_connection *c, void *context) {
  vs_view *v = context;
  pthread_mutex_lock(&v->lock);
  for (int i = 0; i < WATCHERS; i++) {
    if (v->watcher[i]) continue;
    v->watcher[i] = c;
    break;
  }
  pthread_mutex_unlock(&v->lock);
}

static int on_data(struct mg_connection *c, int bits, char *data, size_t size, void *context) {
  (void)c, (void)data, (void)size, (void)context;
  return (bits & 0xf) != MG_WEBSOCKET_OPCODE_CONNECTION_CLOSE;
}

static void on_close(const struct mg_connection *c, void *context) {
  vs_view *v = context;
  pthread_mutex_lock(&v->lock);
  for (int i = 0; i < WATCHERS; i++)
    if (v->watcher[i] == c) v->watcher[i] = NULL;
  pthread_mutex_unlock(&v->lock);
}

// The server answers from its start on, some time before it has its handlers: a request in between would find nothing.
static int wait_for_handlers(struct mg_connection *c) {
  vs_view *v = mg_get_user_data(mg_get_context(c));
  pthread_mutex_lock(&v->lock);
  pthread_mutex_unlock(&v->lock);
  return 0; // on to the handlers
}

static vs_status read_page(vs_view *v, const char *path, vs_error *err) {
  FILE *f = fopen(path, "r");
  if (!f) return vs_fail(err, VS_FAIL, "%s: cannot be read", path);
  v->page = malloc(1 << 20);
  v->page_size = v->page ? fread(v->page, 1, 1 << 20, f) : 0;
  fclose(f);
  return v->page_size > 0 ? VS_OK : vs_fail(err, VS_FAIL, "%s: is empty", path);
}

vs_status vs_view_open(const char *page, const char *data, size_t data_size, const char *address, int port,
                       vs_view **out, vs_error *err) {
  vs_view *v = calloc(1, sizeof *v);
  if (!v) return vs_fail(err, VS_FAIL, "out of memory");
  pthread_mutex_init(&v->lock, NULL);
  v->data = data;
  v->data_size = data_size;
  vs_status s = read_page(v, page, err);
  char where[64];
  snprintf(where, sizeof where, "%.40s:%d", address, port);
  const char *options[] = {"listening_ports", where, "num_threads", "8", "request_timeout_ms", "10000", NULL};
  struct mg_callbacks callbacks = {.begin_request = wait_for_handlers};
  if (s == VS_OK) {
    mg_init_library(0);
    pthread_mutex_lock(&v->lock);
    v->web = mg_start(&callbacks, v, options);
    if (v->web) {
      mg_set_request_handler(v->web, "/", on_page, v);
      mg_set_websocket_handler(v->web, "/live", on_connect, on_ready, on_data, on_close, v);
    }
    pthread_mutex_unlock(&v->lock);
    if (!v->web) {
      mg_exit_library();
      s = vs_fail(err, VS_FAIL, "cannot serve on %s: in use? take another --port", where);
    }
  }
  if (s != VS_OK) {
    vs_view_close(v);
    return s;
  }
  *out = v;
  return VS_OK;
}

void vs_view_close(vs_view *v) {
  if (!v) return;
  if (v->web) {
    mg_stop(v->web);
    mg_exit_library();
  }
  pthread_mutex_destroy(&v->lock);
  free(v->page);
  free(v);
}

void vs_view_send(vs_view *v, const char *text, size_t size) {
  pthread_mutex_lock(&v->lock);
  for (int i = 0; i < WATCHERS; i++)
    if (v->watcher[i]) mg_websocket_write(v->watcher[i], MG_WEBSOCKET_OPCODE_TEXT, text, size);
  pthread_mutex_unlock(&v->lock);
}

int vs_view_watchers(vs_view *v) {
  int n = 0;
  pthread_mutex_lock(&v->lock);
  for (int i = 0; i < WATCHERS; i++) n += v->watcher[i] != NULL;
  pthread_mutex_unlock(&v->lock);
  return n;
}
