"""Requirements of `--require`: properties that identities do not prove, one function each."""
