"""The open files: edited by setting, parsed, saved, merged and recovered."""
