# make fuzz: every tests/fuzz/fuzz_NAME.c for SECONDS each, by clang's libFuzzer under the address and undefined-behaviour
# sanitizers (apt install clang, on Debian 12 libclang-rt-14-dev beside it). What it finds lies in build/fuzz/found.
SECONDS ?= 60
FUZZ_BIN := $(patsubst tests/fuzz/%.c,$(B)/%,$(wildcard tests/fuzz/fuzz_*.c))
.PHONY: fuzz fuzz-run
fuzz:
	@command -v clang >/dev/null || { echo "make fuzz needs clang: apt install clang libclang-rt-14-dev" >&2; exit 2; }
	@$(MAKE) --no-print-directory FLAVOUR=fuzz CC=clang SECONDS=$(SECONDS) fuzz-run

$(B)/fuzz_%: tests/fuzz/fuzz_%.c tests/fuzz/fuzz.h $(ARCHIVES)
	@echo '  FUZZ  $@'
	$(Q)$(CC) $(CFLAGS_ALL) -Itests -fsanitize=fuzzer $(LDFLAGS) -rdynamic -o $@ $< $(WHOLE) $(LDLIBS_ALL)

fuzz-run: $(FUZZ_BIN)
	@sh tests/fuzz/run.sh $(B) $(SECONDS)
