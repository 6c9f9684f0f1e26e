"""Tab "Method": which method the controls edit, its network, policy and switching."""
