# What is installed, and which packages.

# ---- Library ------------------------------------------------------------------------------------
# A host may include the tables of include/ilsa/, *.def, as it does the headers.
INSTALLED = $(HEADERS:include/ilsa/%=$(INCLUDEDIR)/ilsa/%) \
    $(addprefix $(LIBDIR)/,libilsa.a libilsa.so $(SONAME) libilsa.so.$(VERSION)) \
    $(PKGCONFIGDIR)/ilsa.pc $(BINDIR)/ilsa-run

define install_files
install -d "$(DESTDIR)$(INCLUDEDIR)/ilsa" "$(DESTDIR)$(LIBDIR)" "$(DESTDIR)$(PKGCONFIGDIR)"
install -m 644 $(HEADERS) "$(DESTDIR)$(INCLUDEDIR)/ilsa"
install -m 644 $(LIB_A) "$(DESTDIR)$(LIBDIR)"
install -m 755 $(LIB_SO) "$(DESTDIR)$(LIBDIR)"
ln -sf libilsa.so.$(VERSION) "$(DESTDIR)$(LIBDIR)/$(SONAME)"
ln -sf $(SONAME) "$(DESTDIR)$(LIBDIR)/libilsa.so"
$(call pc_file,$(PREFIX),$(LIBDIR:$(PREFIX)%=$${prefix}%),$(INCLUDEDIR:$(PREFIX)%=$${prefix}%),) \
    >"$(DESTDIR)$(PKGCONFIGDIR)/ilsa.pc"
$(if $(filter %/ilsa-run,$(PROGRAMS)),$(install_run))
@if [ -z "$(DESTDIR)" ] && [ "$$(id -u)" = 0 ]; then ldconfig || :; fi
endef

define install_run
install -d "$(DESTDIR)$(BINDIR)"
install -m 755 $(BIN)/ilsa-run "$(DESTDIR)$(BINDIR)"
endef

define uninstall_files
rm -f $(patsubst %,"$(DESTDIR)%",$(INSTALLED))
@rmdir "$(DESTDIR)$(INCLUDEDIR)/ilsa" 2>/dev/null || :
endef

# ---- Packages -----------------------------------------------------------------------------------
define install_missing
missing=; \
for p in $1; do \
    dpkg-query -W -f '$${db:Status-Status}\n' $$p 2>/dev/null | grep -qx installed \
        || missing="$$missing $$p"; \
done; \
[ -z "$$missing" ] && exit 0; \
command -v apt-get >/dev/null || { $(call stop,no apt-get here; install the like of$$missing); }; \
echo "installing$$missing"; \
root=; [ "$$(id -u)" = 0 ] || root=sudo; \
$$root env DEBIAN_FRONTEND=noninteractive apt-get update -q && \
$$root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $$missing
endef
