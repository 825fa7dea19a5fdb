"""Which law of friction an engine has, how fast its errors fall, and to what: from short motions, at four steps."""
