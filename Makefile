# vsss: `make` builds ./vsss, `make test` runs everything, `make help` lists the rest.
# Sources are found by folder: src/<module>/*.c (and folders in a module) go into the program, src/<module>/*.cpp are shims built as modules
# (build/lib/vsss_NAME.so) that a command loads when it needs them. FLAVOUR=asan|tsan builds beside, not over.

.DEFAULT_GOAL := all
# One short line per step; V=1 shows the commands.
Q := $(if $(V),,@)
FLAVOUR ?= plain
B := build/$(FLAVOUR)
PREFIX ?= /usr/local
LIBDIR ?= $(PREFIX)/lib
CC ?= cc
CXX ?= c++

include deploy/features.mk
include deploy/version.mk

# Messages may be cut short: snprintf into a fixed line is how they are made.
# A warning is an error in a checkout, where it can be mended.
WARN := -Wall -Wextra $(if $(wildcard .git),-Werror) -Wno-format-truncation
OPT := -O2 -g
ifeq ($(FLAVOUR),asan)
SAN := -fsanitize=address,undefined -fno-omit-frame-pointer -fno-sanitize-recover=undefined
OPT := -O1 -g
endif
ifeq ($(FLAVOUR),tsan)
SAN := -fsanitize=thread -fno-omit-frame-pointer
OPT := -O1 -g
endif
ifeq ($(FLAVOUR),fuzz)
SAN := -fsanitize=fuzzer-no-link,address,undefined -fno-omit-frame-pointer -fno-sanitize-recover=undefined
OPT := -O1 -g
WARN := -w
endif
# No fused multiply-add: a match must hash the same on every machine and at every optimisation level.
CFLAGS_ALL := -std=gnu11 $(WARN) $(OPT) -ffp-contract=off -fPIC -fvisibility=hidden -pthread -Iinclude -Isrc -isystem build/gen $(FEATURE_CFLAGS) $(SAN) $(CPPFLAGS) $(CFLAGS)
CXXFLAGS_ALL := -std=gnu++17 $(WARN) $(OPT) -fPIC -pthread -Iinclude -Isrc $(SAN) $(CPPFLAGS) $(CXXFLAGS)
LDLIBS_ALL := $(FEATURE_LIBS) -ldl -lm -pthread

LIB_SRC := $(filter-out $(FEATURE_EXCLUDE),$(wildcard src/*/*.c src/*/*/*.c))
CLI_SRC := $(filter-out src/cli/main.c,$(filter src/cli/%,$(LIB_SRC)))
LIB_SRC := $(filter-out src/cli/%,$(LIB_SRC))
LIB_OBJ := $(LIB_SRC:%.c=$(B)/%.o) $(FEATURE_OBJ)
CLI_OBJ := $(CLI_SRC:%.c=$(B)/%.o)
MAIN_OBJ := $(B)/src/cli/main.o
TEST_SRC := $(wildcard tests/*/test_*.c tests/*/*/test_*.c)
BENCH_BIN := $(patsubst %.c,$(B)/%,$(wildcard tests/bench/bench_*.c))
TEST_BIN := $(TEST_SRC:%.c=$(B)/%)
VSSS := $(if $(filter plain,$(FLAVOUR)),vsss,$(B)/vsss)

.PHONY: wheel all test asan tsan lint bench bench-peers clean library install uninstall help features tests
all: features $(VSSS) $(MODULES) $(EXTRA_ALL)


help:
	@echo "make           build ./vsss"
	@echo "make test      build and run all tests; T=module/file runs one (tests/module/test_file.c)"
	@echo "make asan      the tests under the address and undefined-behaviour sanitizers; make tsan: threads"
	@echo "make fuzz      made-up input for every reader, SECONDS=60 each (clang)"
	@echo "make lint      layers, formatting, banned functions, static analysis"
	@echo "make bench     the figures: 'bench NAME VALUE UNIT', medians"
	@echo "make bench-peers  beside the benchmarks of peer projects; INSTALL=1 installs those, N=python: only the Python ones"
	@echo "make wheel     the Python package, build/dist/*.whl"
	@echo "make install   into PREFIX ($(PREFIX)), libraries into LIBDIR ($(LIBDIR)); make uninstall"
	@echo "make library   build/plain/libvsss.so, the C library for other programs; make clean"

ARCHIVES := $(B)/libcli.a $(B)/libvsss.a
WHOLE := -Wl,--whole-archive $(ARCHIVES) -Wl,--no-whole-archive

# -rdynamic: the modules call back what VSSS_API marks.
$(VSSS): $(MAIN_OBJ) $(ARCHIVES)
	@echo '  LD    $@'
	$(Q)$(CC) $(SAN) $(LDFLAGS) -rdynamic -o $@ $(MAIN_OBJ) $(WHOLE) $(LDLIBS_ALL)

$(B)/libvsss.a: $(LIB_OBJ)
	@rm -f $@
	$(Q)ar rcs $@ $(LIB_OBJ)

$(B)/libcli.a: $(CLI_OBJ)
	@rm -f $@
	$(Q)ar rcs $@ $(CLI_OBJ)

# The library for other programs: what the functions marked VSSS_API need, and nothing else.
$(B)/$(LIBRARY): $(B)/libvsss.a
	@echo '  LD    $@'
	@readelf -sW $(LIB_SRC:%.c=$(B)/%.o) | awk '$$4 == "FUNC" && $$5 == "GLOBAL" && $$6 == "DEFAULT" && $$7 != "UND" {print $$8}' | sort -u > $@.names
	@sed 's/^/-Wl,-u,/' $@.names > $@.wanted
	@{ echo '{ global:'; sed 's/$$/;/' $@.names; echo 'local: *; };'; } > $@.map
	$(Q)$(CC) $(SAN) $(LDFLAGS) -shared -Wl,-soname,$(SONAME) $(if $(SAN),,-Wl,-z,defs) -Wl,--as-needed \
	  -Wl,--version-script,$@.map -o $@ @$@.wanted $< $(LDLIBS_ALL)
	@ln -sf $(LIBRARY) $(B)/$(SONAME)
	@ln -sf $(SONAME) $(B)/libvsss.so

$(B)/libvsss.so: $(B)/$(LIBRARY) ;
library: $(B)/libvsss.so

# Written when the flags change, so that everything is compiled again.
$(shell mkdir -p $(B); [ '$(subst ','\'',$(CC) $(CFLAGS_ALL))' = "$$(cat $(B)/flags 2>/dev/null)" ] || \
  printf '%s\n' '$(subst ','\'',$(CC) $(CFLAGS_ALL))' > $(B)/flags)

$(B)/%.o: %.c build/features.mk $(B)/flags | $(GENERATED)
	@mkdir -p $(@D)
	@echo '  CC    $<'
	$(Q)$(CC) $(CFLAGS_ALL) -MMD -MP -c -o $@ $<

# Tests: one binary per file, linked with everything.
$(B)/tests/%: tests/%.c $(ARCHIVES)
	@mkdir -p $(@D)
	@echo '  TEST  $@'
	$(Q)$(CC) $(CFLAGS_ALL) -Itests $(LDFLAGS) -rdynamic -MMD -MP -MF $@.d -o $@ $< $(WHOLE) -lcmocka $(LDLIBS_ALL) -lz

tests: all $(TEST_BIN) $(EXTRA_TESTS)

# With the plain flavour also the Python package's and those of an installed copy: T=python/name, T=install/name.
test: tests $(if $(filter plain,$(FLAVOUR)),$(B)/libvsss.so)
	@sh tests/run.sh $(B) '$(T)'

# Up to GCC 13 the leak checker takes one in 256 dynamic TLS blocks for one of a glibc before 2.25, reads its address from
# what lies before it and dies of it ("Tracer caught signal 11"); it is told not to look for such blocks.
asan:
	@ASAN_OPTIONS=intercept_tls_get_addr=0:$$ASAN_OPTIONS $(MAKE) --no-print-directory FLAVOUR=asan test
tsan:
	@TSAN_OPTIONS=suppressions=$(CURDIR)/tests/tsan.supp $(MAKE) --no-print-directory FLAVOUR=tsan test

include tests/fuzz/fuzz.mk

lint:
	@sh tests/lint.sh

# N=what runs one of tests/bench/bench_what.c.
bench: all $(BENCH_BIN) $(B)/libvsss.so
	@sh tests/bench/run.sh $(B) $(N)

# Peer projects' benchmarks beside ours, where they are installed (INSTALL=1 installs them).
bench-peers: all $(BENCH_BIN) $(B)/libvsss.so
	@sh tests/bench/peers.sh $(B) $(if $(INSTALL),--install,$(if $(filter python,$(N)),--python))

# The Python package for every Python, build/dist/*.whl.
wheel:
	@sh deploy/python/wheel.sh

clean:
	rm -rf build vsss

include deploy/install.mk

-include $(LIB_OBJ:.o=.d) $(CLI_OBJ:.o=.d) $(MAIN_OBJ:.o=.d) $(TEST_BIN:=.d) $(BENCH_BIN:=.d)
