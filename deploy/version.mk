# The release comes from include/vsss/version.h, the commit from git (COMMIT=... says it where there is none).
version_part = $(shell sed -n 's/^\#define VSSS_$(1) //p' include/vsss/version.h)
VERSION := $(call version_part,VERSION_MAJOR).$(call version_part,VERSION_MINOR).$(call version_part,VERSION_PATCH)
ABI := $(call version_part,ABI)
SONAME := libvsss.so.$(ABI)
LIBRARY := libvsss.so.$(VERSION)

COMMIT ?= $(shell [ -e .git ] && git describe --always --dirty --abbrev=12 2>/dev/null || echo unknown)
# Written when it changes, so that main.c alone is compiled again.
$(shell mkdir -p build/gen; line='#define VSSS_COMMIT "$(COMMIT)"'; \
  [ "$$line" = "$$(cat build/gen/vsss_commit.h 2>/dev/null)" ] || printf '%s\n' "$$line" > build/gen/vsss_commit.h)
# Said here: -MMD leaves out what lies in a folder of -isystem.
$(B)/src/cli/main.o: build/gen/vsss_commit.h

# What deploy/probe.sh looks for, but for physics, which is always there, and for the tests' own library.
FEATURES := $(filter-out MUJOCO CMOCKA,$(shell sed 's/ .*//' build/features.txt))
list = $(shell echo '$(strip $(1))' | sed 's/ /, /g' | tr 'A-Z' 'a-z')
$(B)/src/cli/version.o: deploy/version.mk
$(B)/src/cli/version.o: CFLAGS_ALL += \
  -DVSSS_FEATURES='"$(call list,$(foreach f,$(FEATURES),$(if $(HAVE_$(f)),$(f))))"' \
  -DVSSS_MISSING='"$(call list,$(foreach f,$(FEATURES),$(if $(HAVE_$(f)),,$(f))))"'
$(B)/src/base/paths.o: CFLAGS_ALL += -DVSSS_PREFIX='"$(PREFIX)"' -DVSSS_LIBDIR='"$(patsubst $(PREFIX)/%,%,$(LIBDIR))"'
