# vsss: `make` builds ./vsss, `make test` runs everything, `make help` lists the rest.
# Sources are found by folder: src/<module>/*.c go into the program, src/<module>/*.cpp are shims built as modules
# (build/lib/vsss_NAME.so) that a command loads when it needs them. FLAVOUR=asan|tsan builds beside, not over.

FLAVOUR ?= plain
B := build/$(FLAVOUR)
PREFIX ?= /usr/local
CC ?= cc
CXX ?= c++

include deploy/features.mk

# Messages may be cut short: snprintf into a fixed line is how they are made.
WARN := -Wall -Wextra -Werror -Wno-format-truncation
OPT := -O2 -g
# No fused multiply-add: a match must hash the same on every machine and at every optimisation level.
CFLAGS_ALL := -std=gnu11 $(WARN) $(OPT) -ffp-contract=off -fPIC -pthread -Iinclude -Isrc -isystem build/gen -DVSSS_PREFIX='"$(PREFIX)"' $(FEATURE_CFLAGS) $(SAN) $(CFLAGS)
CXXFLAGS_ALL := -std=gnu++17 $(WARN) $(OPT) -fPIC -pthread -Iinclude -Isrc $(SAN) $(CXXFLAGS)
LDLIBS_ALL := $(FEATURE_LIBS) -ldl -lm -pthread

ifeq ($(FLAVOUR),asan)
SAN := -fsanitize=address,undefined -fno-omit-frame-pointer -fno-sanitize-recover=undefined
OPT := -O1 -g
endif
ifeq ($(FLAVOUR),tsan)
SAN := -fsanitize=thread -fno-omit-frame-pointer
OPT := -O1 -g
endif

LIB_SRC := $(filter-out $(FEATURE_EXCLUDE),$(wildcard src/*/*.c))
LIB_SRC := $(filter-out src/cli/main.c,$(LIB_SRC))
LIB_OBJ := $(LIB_SRC:%.c=$(B)/%.o) $(FEATURE_OBJ)
MAIN_OBJ := $(B)/src/cli/main.o
TEST_SRC := $(wildcard tests/*/test_*.c)
TEST_BIN := $(TEST_SRC:%.c=$(B)/%)
VSSS := $(if $(filter plain,$(FLAVOUR)),vsss,$(B)/vsss)

.PHONY: all test asan tsan lint bench clean install help features tests
all: features $(VSSS) $(MODULES) $(EXTRA_ALL)

help:
	@echo "make           build ./vsss"
	@echo "make test      build and run all tests; T=module/file runs one (tests/module/test_file.c)"
	@echo "make asan      the tests under the address and undefined-behaviour sanitizers; make tsan: threads"
	@echo "make lint      layers, formatting, banned functions, static analysis"
	@echo "make bench     the figures: 'bench NAME VALUE UNIT', medians"
	@echo "make install   into PREFIX ($(PREFIX)); make clean"

$(VSSS): $(MAIN_OBJ) $(B)/libvsss.a
	$(CC) $(SAN) -rdynamic -o $@ $(MAIN_OBJ) -Wl,--whole-archive $(B)/libvsss.a -Wl,--no-whole-archive $(LDLIBS_ALL)

$(B)/libvsss.a: $(LIB_OBJ)
	@rm -f $@
	ar rcs $@ $(LIB_OBJ)

$(B)/%.o: %.c $(GENERATED) | build/features
	@mkdir -p $(@D)
	$(CC) $(CFLAGS_ALL) $(CFLAGS_$(notdir $*)) -MMD -MP -c -o $@ $<

# Tests: one binary per file, linked with everything.
$(B)/tests/%: tests/%.c $(B)/libvsss.a $(GENERATED)
	@mkdir -p $(@D)
	$(CC) $(CFLAGS_ALL) -Itests -rdynamic -MMD -MP -MF $@.d -o $@ $< -Wl,--whole-archive $(B)/libvsss.a -Wl,--no-whole-archive -lcmocka $(LDLIBS_ALL) $(TEST_LIBS_$(notdir $*))

tests: all $(TEST_BIN) $(EXTRA_TESTS)

test: tests
	@sh tests/run.sh $(B) $(T)

asan:
	@$(MAKE) --no-print-directory FLAVOUR=asan test
tsan:
	@$(MAKE) --no-print-directory FLAVOUR=tsan test

lint:
	@sh tests/lint/run.sh

bench: all
	@sh tests/bench/run.sh $(N)

clean:
	rm -rf build vsss

-include $(LIB_OBJ:.o=.d) $(MAIN_OBJ:.o=.d) $(TEST_BIN:=.d)
