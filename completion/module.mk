# bash loads the file of the program's name, so that all names lead to one file; zsh reads the names in its file.
bashcompletiondir = $(datadir)/bash-completion/completions
zshcompletiondir = $(datadir)/zsh/site-functions
COMPLETED_TOO = duite-compare duite-garment duite-graph duite-mannequin duite-predict duite-trace duite-view
EXTRA_DIST += completion/duite.bash
dist_zshcompletion_DATA = completion/_duite

install-data-local:
	$(MKDIR_P) '$(DESTDIR)$(bashcompletiondir)'
	$(INSTALL_DATA) $(srcdir)/completion/duite.bash '$(DESTDIR)$(bashcompletiondir)/duite-cloth'
	cd '$(DESTDIR)$(bashcompletiondir)' && for program in $(COMPLETED_TOO); do \
	  rm -f $$program && $(LN_S) duite-cloth $$program || exit; done

uninstall-local:
	for program in duite-cloth $(COMPLETED_TOO); do rm -f '$(DESTDIR)$(bashcompletiondir)'/$$program; done
