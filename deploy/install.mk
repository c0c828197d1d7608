# ./vsss, the modules, the models and the C library with its stable headers, readable by everybody. PREFIX, LIBDIR (a folder
# below PREFIX) and DESTDIR as usual.
STABLE_HEADERS := $(shell grep -l '^// Stable' include/vsss/*.h)
SHARED := models lcm_types deploy/config deploy/calibration deploy/firmware deploy/systemd deploy/examples deploy/docs
D_BIN := $(DESTDIR)$(PREFIX)/bin
D_LIB := $(DESTDIR)$(LIBDIR)
D_INCLUDE := $(DESTDIR)$(PREFIX)/include/vsss
D_SHARE := $(DESTDIR)$(PREFIX)/share/vsss
D_MAN := $(DESTDIR)$(PREFIX)/share/man/man1
D_COMPLETIONS := $(DESTDIR)$(PREFIX)/share/bash-completion/completions
D_UDEV := $(DESTDIR)$(PREFIX)/lib/udev/rules.d
# $(call fill,FILE,FOLDER): a template of deploy/package, filled in.
define fill
	@sed 's|@PREFIX@|$(PREFIX)|; s|@LIBDIR@|$(LIBDIR)|; s|@VERSION@|$(VERSION)|g; s|@LIBRARY@|$(LIBRARY)|; s|@SONAME@|$(SONAME)|' \
	  deploy/package/$(1).in > $(B)/$(1)
	install -m 644 $(B)/$(1) $(2)
endef

install: all $(B)/$(LIBRARY)
	install -d $(D_BIN) $(D_LIB)/vsss $(D_LIB)/pkgconfig $(D_LIB)/cmake/vsss $(D_INCLUDE) $(D_SHARE) $(D_MAN) $(D_COMPLETIONS) $(D_UDEV)
	install -m 755 $(VSSS) $(D_BIN)/vsss
	install -m 644 $(B)/$(LIBRARY) $(D_LIB)/$(LIBRARY)
	ln -sf $(LIBRARY) $(D_LIB)/$(SONAME)
	ln -sf $(SONAME) $(D_LIB)/libvsss.so
	install -m 644 $(STABLE_HEADERS) $(D_INCLUDE)
	$(if $(MODULES),install -m 644 $(MODULES) $(D_LIB)/vsss)
	@for f in $(wildcard build/onnxruntime/lib/libonnxruntime.so.1); do install -m 644 $$f $(D_LIB)/vsss; done
	@for f in $$(if [ -e .git ]; then git ls-files $(SHARED); else find $(SHARED) -type f; fi); do install -D -m 644 $$f $(D_SHARE)/$$f; done
	@sh deploy/package/man.sh ./$(VSSS) > $(B)/vsss.1
	@sh deploy/package/completion.sh ./$(VSSS) > $(B)/completion
	install -m 644 $(B)/vsss.1 $(D_MAN)/vsss.1
	install -m 644 $(B)/completion $(D_COMPLETIONS)/vsss
	install -m 644 deploy/package/60-vsss.rules $(D_UDEV)
	$(call fill,vsss.pc,$(D_LIB)/pkgconfig)
	$(call fill,vsss-config.cmake,$(D_LIB)/cmake/vsss)
	$(call fill,vsss-config-version.cmake,$(D_LIB)/cmake/vsss)

uninstall:
	rm -f $(D_BIN)/vsss $(D_LIB)/$(LIBRARY) $(D_LIB)/$(SONAME) $(D_LIB)/libvsss.so $(D_LIB)/pkgconfig/vsss.pc \
	  $(D_MAN)/vsss.1 $(D_COMPLETIONS)/vsss $(D_UDEV)/60-vsss.rules
	rm -rf $(D_LIB)/vsss $(D_LIB)/cmake/vsss $(D_INCLUDE) $(D_SHARE)
