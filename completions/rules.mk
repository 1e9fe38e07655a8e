# Completion for bash, zsh and fish. bash and fish find a file by the command's name: each tool has a link.
BASH_COMPLETIONS ?= share/bash-completion/completions
ZSH_COMPLETIONS ?= share/zsh/site-functions
FISH_COMPLETIONS ?= share/fish/vendor_completions.d
INSTALLED += 644:completions/retex.bash:$(BASH_COMPLETIONS)/retex 644:completions/_retex:$(ZSH_COMPLETIONS)/ \
	644:completions/retex.fish:$(FISH_COMPLETIONS)/ \
	$(foreach tool,$(filter-out retex,$(TOOLS)),link:retex:$(BASH_COMPLETIONS)/$(tool) \
	link:retex.fish:$(FISH_COMPLETIONS)/$(tool).fish)
