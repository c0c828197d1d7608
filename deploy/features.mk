# What this machine has. Sets FEATURE_CFLAGS, FEATURE_LIBS, FEATURE_EXCLUDE (sources left out), FEATURE_OBJ, MODULES
# (C++ or heavy shims built as build/lib/vsss_NAME.so), GENERATED (headers made before compiling).
exists = $(wildcard $(firstword $(wildcard $(addsuffix /$(1),/usr/include /usr/local/include))))

FEATURE_LIBS := -lmujoco

build/features:
	@mkdir -p build && touch $@
features: build/features
