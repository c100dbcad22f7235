"""One page of HTML that plays a run in any browser, without a network: what is in it, and how it is packed."""
