"""One page of HTML that plays a run in any browser, without a network."""
